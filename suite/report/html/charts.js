"use strict";
// Charts: plotly draws the lines of the scene, the clock and the planners that are chosen.
for (const figure of document.querySelectorAll("[data-chart]")) {
  const { lines, layouts } = JSON.parse(figure.querySelector("[data-lines]").textContent);
  const [scene, clock] = ["scene", "clock"].map((name) => figure.querySelector(`[data-choice=${name}]`));
  const boxes = [...figure.querySelectorAll("input[type=checkbox]")];
  const silent = figure.querySelector("[data-silent]");

  const draw = () => {
    const here = lines.filter((line) => line.scene === scene.value && line.clock === clock.value);
    const wanted = boxes.filter((box) => box.checked).map((box) => box.value);
    const shown = here.filter((line) => wanted.includes(line.planner));
    const drawn = new Set(here.map((line) => line.planner));
    const missing = wanted.filter((planner) => !drawn.has(planner));
    silent.textContent = missing.length
      ? `Not drawn here, for they found no path or do not count: ${missing.join(", ")}.`
      : "";
    Plotly.react(figure.querySelector(".plot"), shown.map((line) => line.trace), layouts[clock.value], plotlyConfig);
  };

  const choose = (all) => {
    for (const box of boxes) box.checked = all;
    draw();
  };

  plotlyThere.then(() => {
    for (const control of [scene, clock, ...boxes]) control.addEventListener("change", draw);
    for (const button of figure.querySelectorAll("[data-all]"))
      button.addEventListener("click", () => choose(button.dataset.all === "yes"));
    draw();
  });
}
