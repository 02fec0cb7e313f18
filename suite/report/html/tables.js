"use strict";
// Tables: a click on a heading sorts by it, a filter keeps the rows that have all its words.
(() => {
  document.querySelector("[data-no-script]").hidden = true;

  const collator = new Intl.Collator("en", { numeric: true });

  // A number to sort by: the cell's own, or the one that its text begins with ("0.25 (13 of 20)").
  function keyOf(row, column) {
    const cell = row.cells[column];
    const text = cell.textContent.trim();
    const number = cell.dataset.n !== undefined ? Number(cell.dataset.n) : Number.parseFloat(text);
    return { text, number };
  }

  function compare(a, b) {
    const numbers = !Number.isNaN(a.number) && !Number.isNaN(b.number);
    return numbers && a.number !== b.number ? a.number - b.number : collator.compare(a.text, b.text);
  }

  function sort(table, heading) {
    const up = heading.getAttribute("aria-sort") !== "ascending";
    for (const other of table.tHead.rows[0].cells) other.removeAttribute("aria-sort");
    heading.setAttribute("aria-sort", up ? "ascending" : "descending");
    const rows = [...table.tBodies[0].rows].map((row) => ({ row, key: keyOf(row, heading.cellIndex) }));
    rows.sort((a, b) => {
      // What is missing comes last in both orders.
      if (!a.key.text || !b.key.text) return Number(!a.key.text) - Number(!b.key.text);
      return up ? compare(a.key, b.key) : compare(b.key, a.key);
    });
    table.tBodies[0].append(...rows.map(({ row }) => row));
  }

  function filter(input) {
    const name = input.dataset.filter;
    const rows = document.querySelector(`[data-table="${name}"]`).tBodies[0].rows;
    const words = input.value.toLowerCase().split(/\s+/).filter(Boolean);
    let shown = 0;
    for (const row of rows) {
      const text = [...row.cells].map((cell) => cell.textContent).join(" ").toLowerCase();
      row.hidden = !words.every((word) => text.includes(word));
      shown += row.hidden ? 0 : 1;
    }
    document.getElementById(`count-${name}`).textContent =
      shown === rows.length ? `${shown} rows` : `${shown} of ${rows.length} rows`;
  }

  for (const button of document.querySelectorAll("th button")) {
    button.addEventListener("click", () => sort(button.closest("table"), button.parentElement));
  }
  for (const input of document.querySelectorAll("[data-filter]")) {
    input.addEventListener("input", () => filter(input));
  }
})();
