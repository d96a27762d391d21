// The starts from above: the drawing of `vlaprobe draw`. To point at a thing shows a start in which it stands so; to drag it, or to
// move it with the arrow keys, asks for another place.
import { h, replace } from "../../../report/page/src/dom";

export interface TopHost {
  show(start: number): void;
  // In metres; `from` is where it is drawn.
  move(object: string, from: [number, number], to: [number, number]): void;
}

export class Top {
  readonly element = h("div", { class: "top" });
  private start = 0;
  constructor(private readonly host: TopHost) {}

  fail(why: string): void { replace(this.element, h("p", { class: "note" }, why)); }

  draw(text: string): void {
    const root = new DOMParser().parseFromString(text, "image/svg+xml").documentElement;
    if (!(root instanceof SVGSVGElement) && root.nodeName !== "svg") return this.fail("the drawing cannot be read");
    const svg = document.importNode(root, true) as unknown as SVGSVGElement;
    // The plot with its rulers; colours are those of the instructions, which stand beside it.
    const [x, y, width, height] = svg.dataset.plot!.split(" ").map(Number) as [number, number, number, number];
    svg.setAttribute("viewBox", `${x - 52} ${y - 8} ${width + 62} ${height + 54}`);
    svg.removeAttribute("width");
    svg.removeAttribute("height");
    svg.setAttribute("role", "group");
    svg.setAttribute("aria-label", "The starts from above");
    const scale = Number(svg.dataset.scale);
    // Where a thing stands in the start that is shown it is taken by the mouse before the others.
    for (const print of this.prints(svg)) {
      print.setAttribute("tabindex", "0");
      print.setAttribute("role", "button");
      print.setAttribute("aria-label", print.querySelector("title")!.textContent!);
      print.addEventListener("pointerenter", (event) => { if (event.buttons === 0) this.look(print); });
      print.addEventListener("focus", () => this.look(print));
      print.addEventListener("keydown", (event) => {
        const step = event.shiftKey ? 0.001 : 0.01;
        const by = ({ ArrowLeft: [-step, 0], ArrowRight: [step, 0], ArrowUp: [0, step], ArrowDown: [0, -step] } as Record<string, [number, number]>)[event.key];
        if (!by) return;
        event.preventDefault();
        this.shift(print, by);
      });
      this.draggable(print, svg, scale);
    }
    const had = (document.activeElement as HTMLElement | null)?.dataset.object;
    replace(this.element, svg);
    // Words and legend around the plot, which would be seen where the pane has another shape.
    for (const part of [...svg.children] as SVGGraphicsElement[]) {
      if (!part.getBBox || part.tagName === "title") continue;
      const box = part.getBBox();
      if (box.x >= x + width + 8 || box.y + box.height <= y - 2) part.remove();
    }
    this.mark(this.start);
    // Whoever moves a thing by keys goes on with it.
    if (had) (this.prints(svg).find((print) => print.dataset.object === had && print.classList.contains("now")) as SVGElement | undefined)?.focus({ preventScroll: true });
  }

  private prints(svg: Element): SVGGElement[] { return [...svg.querySelectorAll<SVGGElement>("g[data-object]")]; }
  private starts(print: SVGElement): number[] { return print.dataset.starts!.split(" ").map(Number); }
  private look(print: SVGElement): void {
    const starts = this.starts(print);
    if (!starts.includes(this.start)) this.host.show(starts[0]!);
  }

  mark(start: number): void {
    this.start = start;
    const svg = this.element.querySelector("svg");
    if (!svg) return;
    for (const print of this.prints(svg)) print.classList.toggle("now", this.starts(print).includes(start));
  }

  private shift(print: SVGGElement, by: [number, number]): void {
    const from = print.dataset.at!.split(" ").map(Number) as [number, number];
    this.host.move(print.dataset.object!, from, [from[0] + by[0], from[1] + by[1]]);
  }

  private draggable(print: SVGGElement, svg: SVGSVGElement, scale: number): void {
    let from: DOMPoint | null = null;
    const at = (event: PointerEvent): DOMPoint => new DOMPoint(event.clientX, event.clientY).matrixTransform(svg.getScreenCTM()!.inverse());
    print.addEventListener("pointerdown", (event) => {
      if (event.button !== 0) return;
      from = at(event);
      print.setPointerCapture(event.pointerId);
      print.classList.add("dragged");
      event.preventDefault();
    });
    print.addEventListener("pointermove", (event) => {
      if (!from) return;
      const now = at(event);
      print.setAttribute("transform", `translate(${now.x - from.x} ${now.y - from.y})`);
    });
    const end = (event: PointerEvent, isDone: boolean): void => {
      if (!from) return;
      const now = at(event);
      const by: [number, number] = [(now.x - from.x) / scale, (from.y - now.y) / scale];
      from = null;
      print.classList.remove("dragged");
      print.removeAttribute("transform");
      if (isDone && Math.hypot(...by) > 0.0005) this.shift(print, by);
      else if (isDone) print.focus();
    };
    print.addEventListener("pointerup", (event) => end(event, true));
    print.addEventListener("pointercancel", (event) => end(event, false));
  }
}
