"use strict";
// Maps: the planners that are chosen, on the picture of the hardest queries and among the marks.
for (const panel of document.querySelectorAll("[data-map]")) {
  const choice = panel.querySelector("[data-choice=query]");
  const boxes = [...panel.querySelectorAll("input[type=checkbox]")];
  const marks = panel.querySelector("[data-marks]");
  const plot = panel.querySelector(".plot");
  const data = marks && JSON.parse(marks.textContent);

  const wanted = () => new Set(boxes.filter((box) => box.checked).map((box) => box.value));

  function drawMap() {
    const planners = wanted();
    const query = choice ? choice.value : "";
    for (const group of panel.querySelectorAll("g[data-query]"))
      group.classList.toggle("off", query !== "" && group.dataset.query !== query);
    for (const way of panel.querySelectorAll("[data-planner]"))
      way.classList.toggle("off", !planners.has(way.dataset.planner));
  }

  function trace({ trace: style, gaps }) {
    const asked = gaps.map((gap) => gap !== false);
    const of = (values) => values.filter((_, i) => asked[i]);
    const found = of(gaps);
    return {
      ...style,
      x: of(data.lengths),
      y: found.map((gap) => (gap === null ? data.noPath : Math.max(gap, data.least))),
      text: of(data.names),
      customdata: found.map((gap) => (gap === null ? "no path" : `gap ${gap} %`)),
      meta: of(data.hard),
    };
  }

  // The numbers of the hardest queries, above all marks; the chosen one is bold.
  function numbers() {
    const query = choice ? choice.value : "";
    return data.hard.flatMap((number, i) => {
      if (!number) return [];
      const x = data.layout.xaxis.type === "log" ? Math.log10(data.lengths[i]) : data.lengths[i];
      const text = String(number) === query ? `<b>${number}</b>` : String(number);
      return [{ x, y: 1, yref: "paper", yanchor: "bottom", text, showarrow: false }];
    });
  }

  function drawMarks() {
    if (!data) return;
    const planners = wanted();
    const shown = data.planners.filter(({ trace: style }) => planners.has(style.name));
    Plotly.react(plot, shown.map(trace), { ...data.layout, annotations: numbers() }, plotlyConfig);
  }

  const draw = () => {
    drawMap();
    drawMarks();
  };

  // The marks stay: of thousands a browser takes a while to draw them anew.
  const choose = () => {
    drawMap();
    if (data) Plotly.relayout(plot, { annotations: numbers() });
  };

  plotlyThere.then(() => {
    draw();
    if (choice) choice.addEventListener("change", choose);
    for (const box of boxes) box.addEventListener("change", draw);
    for (const button of panel.querySelectorAll("[data-all]")) {
      button.addEventListener("click", () => {
        for (const box of boxes) box.checked = button.dataset.all === "yes";
        draw();
      });
    }
    if (data && choice) {
      plot.on("plotly_click", ({ points }) => {
        const number = points.map((point) => point.data.meta[point.pointNumber]).find(Boolean);
        if (!number) return;
        choice.value = String(number);
        choose();
      });
    }
  });
}
// All that is drawn when the page is opened is drawn.
plotlyThere.then(() => (document.documentElement.dataset.drawn = "yes"), () => {});
