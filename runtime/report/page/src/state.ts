// What the reader chose: which policies are drawn. Panels that depend on it are drawn again when it changes.
import { forgetDetached, redrawAll } from "./chart";
import { type Data, EpisodeIndex } from "./model";

const kMostDrawn = 6;

export class State {
  readonly index: EpisodeIndex;
  chosen: number[];
  private readonly redraws: (() => void)[] = [];

  constructor(readonly data: Data) {
    this.index = new EpisodeIndex(data);
    const all = [...data.policies.keys()];
    // Someone else's models first, then what tells how the tasks behave.
    const rank = (p: number): number => (data.policies[p]!.role === "model" ? 0 : 1);
    this.chosen = all.length <= kMostDrawn + 2 ? all : [...all].sort((a, b) => rank(a) - rank(b) || a - b).slice(0, kMostDrawn).sort((a, b) => a - b);
  }

  // Calls `redraw` now and whenever the choice or the colours change.
  watch(redraw: () => void): void {
    this.redraws.push(redraw);
    redraw();
  }
  choose(policies: number[]): void {
    this.chosen = [...policies].sort((a, b) => a - b);
    this.refresh();
  }
  refresh(): void {
    for (const redraw of this.redraws) redraw();
    forgetDetached();
    redrawAll();
  }
  // The one to show where only one fits: the first that is neither floor nor ceiling.
  typical(): number {
    const of = (list: number[]) => list.find((p) => !["floor", "ceiling"].includes(this.data.policies[p]!.role));
    return of(this.chosen) ?? this.chosen[0] ?? 0;
  }
}
