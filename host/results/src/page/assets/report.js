// Draws every picture of the report as it comes into view.
"use strict";
{
  const drawings = JSON.parse(document.getElementById("drawings").textContent);
  const draw = (div) => {
    if (div.dataset.drawn) return Promise.resolve();
    div.dataset.drawn = "yes";
    return servoid.draw(div, drawings[div.id]);
  };
  const divs = Array.from(document.querySelectorAll(".plot"));
  const seen = new IntersectionObserver((entries) => {
    for (const entry of entries) {
      if (entry.isIntersecting) {
        seen.unobserve(entry.target);
        draw(entry.target);
      }
    }
  }, { rootMargin: "600px" });
  divs.forEach((div) => seen.observe(div));
  addEventListener("beforeprint", () => divs.forEach(draw));
}
