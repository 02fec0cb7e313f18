"use strict";
// The player: steps through the generations of a run on the map of its scene.
for (const player of document.querySelectorAll("[data-player]")) {
  const find = (selector) => player.querySelector(selector);
  const runs = JSON.parse(find("[data-runs]").textContent);
  const choice = find("#player-run");
  const slider = find("#player-generation");
  const playButton = find("[data-play]");
  const stage = find("[data-stage]");
  const told = find("[data-told]");
  const calm = window.matchMedia("(prefers-reduced-motion: reduce)");
  let timer = null;

  const run = () => runs[Number(choice.value)];
  const number = (value, unit, digits = 2) =>
    value === null || value === undefined ? "none yet" : `${value.toFixed(digits)} ${unit}`;

  function textsOf(frame) {
    const { optimum, frames } = run();
    // Lengths are rounded in the page: none is shorter than the optimum.
    const gap = optimum && frame.cost !== null ? Math.max(100 * (frame.cost / optimum - 1), 0) : null;
    return {
      generation: `${frame.g} of ${frames.at(-1).g}`,
      cost: number(frame.cost, "m"),
      gap: optimum ? number(gap, "%") : "no optimum is known",
      mean: frame.mean === undefined ? "not recorded" : number(frame.mean, "m"),
      share: frame.share === undefined ? "not recorded" : `${(100 * frame.share).toFixed(0)} %`,
    };
  }

  function show(tell) {
    const frame = run().frames[Number(slider.value)];
    const texts = textsOf(frame);
    find("[data-population]").setAttribute("d", frame.d);
    find("[data-best]").setAttribute("d", frame.best);
    for (const [name, text] of Object.entries(texts)) find(`[data-value=${name}]`).textContent = text;
    const words = `Generation ${texts.generation}: ${frame.n} paths, best cost ${texts.cost}`;
    stage.setAttribute("aria-label", `${run().label}. ${words}.`);
    slider.setAttribute("aria-valuetext", words);
    // While it plays, a screen reader would not come to an end; the slider speaks for itself.
    if (tell) told.textContent = words;
  }

  function choose() {
    stop();
    const { scene, viewBox, ends, frames } = run();
    stage.setAttribute("viewBox", viewBox);
    find("[data-room]").setAttribute("href", `#scene-${scene}`);
    ["start", "goal"].forEach((end, i) => {
      const [x, y] = ends[i];
      find(`[data-end=${end}]`).setAttribute("x", x);
      find(`[data-end=${end}]`).setAttribute("y", y);
    });
    slider.max = frames.length - 1;
    slider.value = 0;
    show(false);
  }

  function go(to, tell = true) {
    slider.value = Math.min(Math.max(to, 0), Number(slider.max));
    show(tell);
  }

  function stop() {
    clearInterval(timer);
    timer = null;
    playButton.textContent = "Play";
  }

  function play() {
    if (Number(slider.value) === Number(slider.max)) go(0, false);
    playButton.textContent = "Pause";
    timer = setInterval(() => {
      go(Number(slider.value) + 1, false);
      if (Number(slider.value) === Number(slider.max)) {
        stop();
        show(true);
      }
    }, calm.matches ? 1500 : 400);
  }

  const targets = {
    first: () => 0,
    back: () => Number(slider.value) - 1,
    on: () => Number(slider.value) + 1,
    last: () => Number(slider.max),
  };
  for (const button of player.querySelectorAll("[data-step]")) {
    button.addEventListener("click", () => {
      stop();
      go(targets[button.dataset.step]());
    });
  }
  playButton.addEventListener("click", () => (timer === null ? play() : stop()));
  slider.addEventListener("input", () => {
    stop();
    show(false);
  });
  choice.addEventListener("change", choose);
  choose();
}
