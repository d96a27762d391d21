// The verdicts over the steps of an episode: a lane each, truths as steps, numbers between their extremes.
import { LineChart } from "echarts/charts";
import { GridComponent, MarkLineComponent } from "echarts/components";
import { type EChartsType, init, use } from "echarts/core";
import { SVGRenderer } from "echarts/renderers";
import { h } from "../../../report/page/src/dom";
import { policyColor, token } from "../../../report/page/src/theme";

use([LineChart, GridComponent, MarkLineComponent, SVGRenderer]);

export interface Metric { name: string; truth: boolean }

export class Timeline {
  readonly element = h("div", { class: "timeline", role: "img", "aria-label": "Verdicts by step" });
  private chart: EChartsType | undefined;
  private metrics: Metric[] = [];
  private values: number[][] = [];  // by step, by metric
  private horizon = 1;
  private step = 0;
  private due = false;
  constructor(private readonly look: (step: number) => void) {
    new ResizeObserver(() => this.chart?.resize()).observe(this.element);
  }
  begin(metrics: Metric[], horizon: number): void {
    this.metrics = metrics;
    this.horizon = horizon;
    this.values = [];
    this.step = 0;
    this.draw();
  }
  add(step: number, values: number[]): void {
    this.values[step] = values;
    this.mark(step);
  }
  mark(step: number): void {
    this.step = step;
    if (this.due) return;
    this.due = true;
    requestAnimationFrame(() => { this.due = false; this.draw(); });
  }
  draw(): void {
    if (!this.chart) {
      this.chart = init(this.element, null, { renderer: "svg" });
      this.chart.getZr().on("click", (event: { offsetX: number; offsetY: number }) => {
        const point = this.chart!.convertFromPixel({ gridIndex: 0 }, [event.offsetX, event.offsetY]) as number[] | undefined;
        if (point) this.look(Math.max(0, Math.min(this.values.length - 1, Math.round(point[0]!))));
      });
    }
    const lanes = this.metrics.length;
    const series = this.metrics.map((metric, lane) => {
      const all = this.values.map((values) => values[lane] ?? 0);
      const low = metric.truth ? 0 : Math.min(...all), high = metric.truth ? 1 : Math.max(...all);
      const base = lanes - 1 - lane;
      return {
        type: "line" as const, step: metric.truth ? "end" as const : undefined, symbol: "none", animation: false, silent: true,
        lineStyle: { width: 1.6, color: policyColor(lane) }, areaStyle: metric.truth ? { color: policyColor(lane), opacity: 0.22, origin: base } : undefined,
        data: all.map((value, step) => [step, base + (high > low ? (0.72 * (value - low)) / (high - low) : 0)]),
        markLine: lane ? undefined : { symbol: "none", silent: true, animation: false, label: { show: false }, lineStyle: { color: token("--accent"), type: "solid" as const, width: 1.5 }, data: [{ xAxis: this.step }] },
      };
    });
    this.chart.setOption({
      animation: false, textStyle: { fontFamily: token("--sans"), color: token("--ink") },
      grid: { left: 128, right: 14, top: 6, bottom: 22 },
      xAxis: { type: "value", min: 0, max: this.horizon, axisLabel: { color: token("--soft"), fontSize: 11 }, splitLine: { show: false }, axisLine: { lineStyle: { color: token("--rule-strong") } } },
      yAxis: { type: "value", min: -0.1, max: Math.max(1, lanes), interval: 1, axisLabel: { color: token("--ink"), fontSize: 11, width: 118, overflow: "truncate", formatter: (value: number) => this.metrics[lanes - 1 - Math.round(value)]?.name ?? "" }, splitLine: { lineStyle: { color: token("--rule") } } },
      series,
    }, true);
  }
}
