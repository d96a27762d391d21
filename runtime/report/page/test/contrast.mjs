// Contrast of every visible text of a page with what is behind it (WCAG 2.1, 1.4.3): those below 4.5:1, with the ratio. `besides`: a
// selector of what is not looked at, beside what nobody sees.
export async function lowContrast(page, besides = ".unseen, .skip") {
  const low = await page.evaluate((besides) => {
    const numbers = (color) => { const m = color.match(/[\d.]+/g).map(Number); return { rgb: m.slice(0, 3), a: m[3] ?? 1 }; };
    const luminance = ([r, g, b]) => { const c = [r, g, b].map((v) => (v / 255 <= 0.03928 ? v / 255 / 12.92 : ((v / 255 + 0.055) / 1.055) ** 2.4)); return 0.2126 * c[0] + 0.7152 * c[1] + 0.0722 * c[2]; };
    const found = new Set();
    const walker = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
    while (walker.nextNode()) {
      const element = walker.currentNode.parentElement;
      if (!walker.currentNode.data.trim() || element.closest(`script, noscript, option, [aria-hidden=true], ${besides}`)) continue;
      if (!element.getClientRects().length) continue;
      const style = getComputedStyle(element);
      let ground = element;
      while (ground && numbers(getComputedStyle(ground).backgroundColor).a < 1) ground = ground.parentElement;
      const inSvg = element instanceof SVGElement;
      const a = luminance(numbers(inSvg ? style.fill : style.color).rgb), b = luminance(numbers(ground ? getComputedStyle(ground).backgroundColor : "rgb(255,255,255)").rgb);
      const ratio = (Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05);
      if (ratio < 4.5) found.add(`${ratio.toFixed(2)} ${element.tagName}.${element.getAttribute("class")} in ${element.closest("section, aside, header, footer")?.id ?? "?"}: ${walker.currentNode.data.slice(0, 30)}`);
    }
    return [...found];
  }, besides);
  return low;
}
