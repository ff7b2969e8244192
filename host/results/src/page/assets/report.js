// Draws every picture of the report as it comes into view.
"use strict";
{
  const drawings = JSON.parse(document.getElementById("drawings").textContent);
  const divs = Array.from(document.querySelectorAll(".plot"));

  // What draws is packed, or it would be most of the page.
  const ready = (async () => {
    const packed = Uint8Array.from(atob(document.getElementById("plotly").textContent), (c) => c.charCodeAt(0));
    const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("gzip"));
    const script = document.createElement("script");
    script.textContent = await new Response(stream).text();
    document.head.append(script);
  })();
  ready.catch((error) => divs.forEach((div) => {
    div.textContent = `This browser cannot draw here (${error.message}): open the page in a newer one. The numbers are beneath.`;
  }));

  const draw = async (div) => {
    if (div.dataset.drawn) return;
    div.dataset.drawn = "yes";
    await ready;
    await servoid.draw(div, drawings[div.id]);
    div.on("plotly_click", ({ points }) => unfold(points[0].text));
  };
  // What is folded on this page under the name that a point bears.
  const unfold = (name) => {
    const folded = Array.from(document.querySelectorAll("details.unfold")).find((one) => one.dataset.name === name);
    if (!folded) return;
    folded.open = true;
    folded.scrollIntoView({ block: "nearest" });
    folded.querySelector("summary").focus({ preventScroll: true });
  };
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
