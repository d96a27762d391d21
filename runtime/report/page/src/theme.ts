// Colours, marks and patterns. Policies differ in all three, so that neither colour sight nor colour print is needed.
import { s } from "./dom";

// Each has contrast 3:1 or more with the paper behind it; neighbours differ in lightness as well as in hue.
const kLight = ["#0b6bb0", "#c9540a", "#0a7a5c", "#9b3f8f", "#7d6608", "#4a5361", "#3d35a8", "#b3214e"];
const kDark = ["#62b5ec", "#f0904f", "#41c79b", "#dd92cf", "#d6b54c", "#b9c1cc", "#a9a0f2", "#f48aa8"];

let onPaper = false;
// While the page is printed, colours are those for white paper.
export const setPaper = (paper: boolean): void => { onPaper = paper; };

export const isDark = (): boolean => {
  if (onPaper) return false;
  const chosen = document.documentElement.dataset.theme;
  return chosen ? chosen === "dark" : matchMedia("(prefers-color-scheme: dark)").matches;
};

export const policyColor = (policy: number): string => (isDark() ? kDark : kLight)[policy % kLight.length]!;

// Paths in a square of -1 to 1; ECharts takes them as symbols.
const kMarks = [
  "M0-.9A.9.9 0 1 1 0 .9A.9.9 0 1 1 0-.9Z",
  "M-.8-.8H.8V.8H-.8Z",
  "M0-1L.95 .75H-.95Z",
  "M0-1.05L1.05 0L0 1.05L-1.05 0Z",
  "M0 1L-.95-.75H.95Z",
  "M-.3-1H.3V-.3H1V.3H.3V1H-.3V.3H-1V-.3H-.3Z",
  "M-.55-.95H.55L1.1 0L.55 .95H-.55L-1.1 0Z",
  "M0-1.1L.33-.33H1.1L.5 .2L.72 1L0 .52L-.72 1L-.5 .2L-1.1-.33H-.33Z",
];
// The mark changes a step slower than the colour, so that no two of 64 policies look alike.
export const markPath = (policy: number): string => kMarks[(policy + Math.floor(policy / kMarks.length)) % kMarks.length]!;

export function mark(policy: number, size = 11): SVGElement {
  return s("svg", { class: "mark", viewBox: "-1.2 -1.2 2.4 2.4", width: size, height: size, "aria-hidden": "true" },
    s("path", { d: markPath(policy), fill: policyColor(policy) }));
}

// Bars: patterns over the colour.
const kDecals = [
  { symbol: "none" },
  { symbol: "rect", dashArrayX: [1, 0], dashArrayY: [2, 4], rotation: Math.PI / 4 },
  { symbol: "circle", dashArrayX: [[5, 5], [0, 5, 5, 0]], dashArrayY: [3, 3], symbolSize: 0.7 },
  { symbol: "rect", dashArrayX: [1, 0], dashArrayY: [2, 4], rotation: -Math.PI / 4 },
  { symbol: "rect", dashArrayX: [1, 0], dashArrayY: [2, 5], rotation: 0 },
  { symbol: "rect", dashArrayX: [2, 4], dashArrayY: [1, 0], rotation: 0 },
  { symbol: "diamond", dashArrayX: [[6, 4], [0, 5, 6, 0]], dashArrayY: [4, 2], symbolSize: 0.8 },
  { symbol: "triangle", dashArrayX: [[6, 6], [0, 6, 6, 0]], dashArrayY: [5, 2], symbolSize: 0.7 },
];
export function decal(policy: number): object {
  return { ...kDecals[policy % kDecals.length], color: isDark() ? "rgba(0,0,0,.42)" : "rgba(255,255,255,.6)" };
}
export const dashOf = (policy: number): number[] | "solid" => {
  const dash = [[], [7, 3], [2, 3], [9, 3, 2, 3], [5, 5], [12, 4], [4, 2], [6, 2, 1, 2, 1, 2]][policy % 8]!;
  return dash.length ? dash : "solid";
};

export const token = (name: string): string => getComputedStyle(document.documentElement).getPropertyValue(name).trim();

// 0 to 1 as a shade of one hue, and the ink that reads on it with 4.5:1 or more.
export function shade(x: number): { background: string; ink: string } {
  const dark = isDark();
  const from = dark ? [30, 36, 44] : [247, 249, 251];
  const to = dark ? [120, 190, 240] : [10, 79, 138];
  const mix = from.map((a, i) => Math.round(a + (to[i]! - a) * x));
  const channel = (v: number): number => { const c = v / 255; return c <= 0.03928 ? c / 12.92 : ((c + 0.055) / 1.055) ** 2.4; };
  const light = 0.2126 * channel(mix[0]!) + 0.7152 * channel(mix[1]!) + 0.0722 * channel(mix[2]!);
  // Contrast with white against contrast with black: the greater of the two is never below 4.58.
  return { background: `rgb(${mix.join(",")})`, ink: 1.05 / (light + 0.05) > (light + 0.05) / 0.05 ? "#fff" : "#000" };
}
