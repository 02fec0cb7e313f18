"use strict";
// Plotly, unpacked: it is the largest part of the page, and a third of its size when compressed.
const plotlyConfig = {
  responsive: true,
  displaylogo: false,
  // Named one by one: among plotly's own there is one that sends the chart away.
  modeBarButtons: [["toImage", "zoom2d", "pan2d", "zoomIn2d", "zoomOut2d", "resetScale2d"]],
  plotlyServerURL: "",
};

const plotlyThere = (async () => {
  const packed = document.getElementById("packed-plotly");
  if (!packed) return;
  const bytes = Uint8Array.from(atob(packed.textContent), (letter) => letter.charCodeAt(0));
  const unpacked = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
  const script = document.createElement("script");
  script.textContent = await new Response(unpacked).text();
  document.head.append(script);
})();

plotlyThere.catch((error) => {
  const told = `This browser can't unpack the charts (${error.message}). One of 2023 or later can.`;
  for (const plot of document.querySelectorAll(".plot")) plot.textContent = told;
});
