// Pictures as the program drew them, to the pixel.
import { h } from "../../../report/page/src/dom";
import type { Seen } from "./socket";

export class Pictures {
  readonly element = h("div", { class: "pictures" });
  constructor(private readonly label: string) {}
  // Of each camera one; of a small picture the page keeps the size that it had.
  draw(cameras: Seen[]): void {
    while (this.element.children.length > cameras.length) this.element.lastElementChild!.remove();
    cameras.forEach((camera, i) => {
      let figure = this.element.children[i] as HTMLElement | undefined;
      if (!figure) {
        figure = h("figure", {}, h("canvas", { role: "img" }), h("figcaption", {}));
        this.element.append(figure);
      }
      const canvas = figure.querySelector("canvas")!;
      canvas.setAttribute("aria-label", `${this.label}, camera ${camera.name}`);
      if (canvas.width !== camera.width || canvas.height !== camera.height) {
        canvas.width = camera.width;
        canvas.height = camera.height;
      }
      canvas.getContext("2d")!.putImageData(new ImageData(camera.pixels, camera.width, camera.height), 0, 0);
      figure.querySelector("figcaption")!.textContent = cameras.length > 1 ? camera.name : "";
    });
  }
}
