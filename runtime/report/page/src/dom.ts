// Elements without markup: whatever comes from results becomes a text node or an attribute of a fixed name, never HTML.

export type Child = Node | string | number | null | undefined | false | Child[];
type Properties = Record<string, string | number | boolean | null | undefined | ((event: Event) => void)>;

const kSvg = "http://www.w3.org/2000/svg";

function append(element: Element, children: Child[]): void {
  for (const child of children) {
    if (child === null || child === undefined || child === false) continue;
    if (Array.isArray(child)) append(element, child);
    else element.append(child instanceof Node ? child : String(child));
  }
}

function make<E extends Element>(element: E, properties: Properties, children: Child[]): E {
  for (const [name, value] of Object.entries(properties)) {
    if (value === null || value === undefined || value === false) continue;
    if (typeof value === "function") element.addEventListener(name, value);
    else element.setAttribute(name, value === true ? "" : String(value));
  }
  append(element, children);
  return element;
}

export function h<K extends keyof HTMLElementTagNameMap>(tag: K, properties: Properties = {}, ...children: Child[]): HTMLElementTagNameMap[K] {
  return make(document.createElement(tag), properties, children);
}

export function s<K extends keyof SVGElementTagNameMap>(tag: K, properties: Properties = {}, ...children: Child[]): SVGElementTagNameMap[K] {
  return make(document.createElementNS(kSvg, tag), properties, children);
}

export function replace(element: Element, ...children: Child[]): void {
  element.replaceChildren();
  append(element, children);
}

// A name that may be broken after its underscores and slashes.
export function breakable(name: string): Child[] {
  return (name.match(/[^_/]+[_/]*|[_/]+/g) ?? []).flatMap((part, i) => (i ? [h("wbr"), part] : [part]));
}

let ids = 0;
export const freshId = (): string => `id${++ids}`;

// A labelled choice of one; `chosen` is an index into `labels`.
export function select(label: string, labels: string[], chosen: number, change: (index: number) => void): HTMLElement {
  const id = freshId();
  const list = h("select", { id, change: (event) => change((event.target as HTMLSelectElement).selectedIndex) },
    labels.map((text, i) => h("option", { value: i, selected: i === chosen }, text)));
  return h("span", { class: "control" }, h("label", { for: id }, label), list);
}

export function checkbox(label: string, checked: boolean, change: (checked: boolean) => void): HTMLElement {
  const box = h("input", { type: "checkbox", checked, change: () => change(box.checked) });
  return h("label", { class: "control check" }, box, label);
}

// A table that scrolls sideways by itself, reachable by keyboard.
export function scroller(label: string, table: HTMLElement, tall = false): HTMLElement {
  return h("div", { class: tall ? "scroller tall" : "scroller", tabindex: 0, role: "region", "aria-label": label }, table);
}

export function simpleTable(caption: string, head: Child[], rows: Child[][]): HTMLElement {
  return scroller(caption, h("table", { class: "plain" }, h("caption", {}, caption),
    h("thead", {}, h("tr", {}, head.map((cell) => h("th", { scope: "col" }, cell)))),
    h("tbody", {}, rows.map((row) => h("tr", {}, row.map((cell, i) => (i === 0 ? h("th", { scope: "row" }, cell) : h("td", {}, cell))))))));
}
