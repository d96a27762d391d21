// ECharts, as little of it as the page uses. Charts are drawn when they come into view, drawn again when colours change, and
// sized for paper when printed. Each has a sentence for screen readers; the numbers stand in a table beside it.
import { BarChart, CustomChart, RadarChart, ScatterChart } from "echarts/charts";
import { AriaComponent, GridComponent, RadarComponent, TooltipComponent } from "echarts/components";
import { type EChartsCoreOption, type EChartsType, init, use } from "echarts/core";
import { SVGRenderer } from "echarts/renderers";
import { h } from "./dom";
import { setPaper, token } from "./theme";

use([BarChart, CustomChart, RadarChart, ScatterChart, AriaComponent, GridComponent, RadarComponent, TooltipComponent, SVGRenderer]);

type Options = () => EChartsCoreOption;
interface Chart { element: HTMLElement; options: Options; drawn?: EChartsType }

const charts = new Set<Chart>();
const byElement = new WeakMap<Element, Chart>();

function draw(chart: Chart): void {
  if (!chart.drawn) chart.drawn = init(chart.element, null, { renderer: "svg" });
  chart.drawn.setOption({ animation: false, textStyle: { fontFamily: token("--sans"), color: token("--ink") }, aria: { enabled: false }, ...chart.options() }, true);
}

const seen = new IntersectionObserver((entries) => {
  for (const entry of entries) {
    const chart = byElement.get(entry.target);
    if (chart && entry.isIntersecting && !chart.drawn) draw(chart);
  }
}, { rootMargin: "400px" });
const sized = new ResizeObserver((entries) => {
  for (const entry of entries) byElement.get(entry.target)?.drawn?.resize();
});

export function chart(label: string, height: number, options: Options): HTMLElement {
  const element = h("div", { class: "chart", role: "img", "aria-label": label, style: `height:${height}px` });
  const entry: Chart = { element, options };
  charts.add(entry);
  byElement.set(element, entry);
  seen.observe(element);
  sized.observe(element);
  return element;
}

// Panels that are drawn anew leave their charts behind.
export function forgetDetached(): void {
  for (const entry of charts) {
    if (entry.element.isConnected) continue;
    entry.drawn?.dispose();
    seen.unobserve(entry.element);
    sized.unobserve(entry.element);
    charts.delete(entry);
  }
}

export function redrawAll(): void {
  for (const entry of charts) if (entry.drawn) draw(entry);
}

function forPaper(): void {
  setPaper(true);
  for (const entry of charts) {
    draw(entry);
    entry.drawn!.resize();
  }
}
addEventListener("beforeprint", forPaper);
addEventListener("afterprint", () => {
  setPaper(false);
  for (const entry of charts) {
    draw(entry);
    entry.drawn!.resize();
  }
});

// Common parts.
export const axisStyle = () => ({
  axisLine: { lineStyle: { color: token("--rule-strong") } },
  axisTick: { show: false },
  axisLabel: { color: token("--soft"), fontSize: 12 },
  splitLine: { lineStyle: { color: token("--rule") } },
});
export const percentAxis = (name = "") => ({
  ...axisStyle(), type: "value" as const, min: 0, max: 100, interval: 25, name, nameTextStyle: { color: token("--soft") },
  axisLabel: { color: token("--soft"), fontSize: 12, formatter: "{value} %" },
});
// Text only: what a tooltip shows is built from results.
export function tooltip(text: (parameters: never) => string[]) {
  return {
    trigger: "item" as const, confine: true, backgroundColor: token("--paper"), borderColor: token("--rule-strong"), textStyle: { color: token("--ink"), fontSize: 13 },
    formatter: (parameters: never) => {
      const box = document.createElement("div");
      for (const line of text(parameters)) {
        const row = document.createElement("div");
        row.textContent = line;
        box.append(row);
      }
      return box;
    },
  };
}

interface WhiskerApi {
  value(dimension: number): number;
  coord(point: number[]): number[];
  size(extent: number[]): number[];
}
// Intervals over grouped bars: data of [category, low, high], all in percent; `slot` of `slots` bars in the group.
export function whiskers(data: (number | null)[][], slot: number, slots: number, barWidth: number, gap: number, horizontal: boolean) {
  return {
    type: "custom" as const, silent: true, z: 5, data, encode: horizontal ? { y: 0, x: [1, 2] } : { x: 0, y: [1, 2] },
    renderItem: (_: unknown, api: WhiskerApi) => {
      const category = api.value(0);
      const point = (value: number) => api.coord(horizontal ? [value, category] : [category, value]);
      const a = point(api.value(1)), b = point(api.value(2));
      const step = barWidth * (1 + gap);
      const shift = (slot - (slots - 1) / 2) * step;
      const across = horizontal ? 1 : 0;
      a[across]! += shift;
      b[across]! += shift;
      const cap = Math.min(3, barWidth / 3);
      const style = { stroke: token("--ink"), lineWidth: 1, opacity: 0.75 };
      const line = (x1: number, y1: number, x2: number, y2: number) => ({ type: "line" as const, shape: { x1, y1, x2, y2 }, style });
      const end = (p: number[]) => horizontal ? line(p[0]!, p[1]! - cap, p[0]!, p[1]! + cap) : line(p[0]! - cap, p[1]!, p[0]! + cap, p[1]!);
      return { type: "group" as const, children: [line(a[0]!, a[1]!, b[0]!, b[1]!), end(a), end(b)] };
    },
  };
}
