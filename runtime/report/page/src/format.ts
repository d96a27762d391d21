// Numbers as readers want them.
import type { Estimate } from "./model";

const kMinus = "\u2212";
const kNone = "\u2013";

// Halves away from zero, as in runtime/base/percent.h; 100 times a rate is seldom exact.
export function fixed(x: number, digits: number): string {
  const scale = 10 ** digits;
  const size = Math.floor(Math.abs(x) * scale + 0.5 + 1e-9) / scale;
  return (x < 0 && size > 0 ? -size : size).toFixed(digits);
}

export const rate = (e: Estimate): number | null => (e && e[1] > 0 ? e[4] ?? e[0] / e[1] : null);
export const percent = (x: number | null | undefined, digits = 0): string =>
  x === null || x === undefined || Number.isNaN(x) ? kNone : fixed(100 * x, digits);
export const withUnit = (x: number | null, digits = 0): string => (x === null ? kNone : `${percent(x, digits)} %`);
export const count = (n: number): string => n.toLocaleString("en-US");

// "+12", "-4": percentage points.
export function points(x: number, digits = 0): string {
  const text = fixed(100 * Math.abs(x), digits);
  return (Number(text) === 0 ? "" : x > 0 ? "+" : kMinus) + text;
}
// As many decimals as it takes to show that an interval has width.
function digitsOf(low: number, high: number, text: (x: number, digits: number) => string): number {
  let digits = 0;
  while (digits < 2 && low !== high && text(low, digits) === text(high, digits)) ++digits;
  return digits;
}
export function range(low: number, high: number): string {
  const digits = digitsOf(low, high, percent);
  return `${percent(low, digits)}${kNone}${percent(high, digits)}`;
}
export function signedRange(low: number, high: number): string {
  const digits = digitsOf(low, high, points);
  return `${points(low, digits)} to ${points(high, digits)}`;
}
export function probability(p: number | null | undefined): string {
  if (p === null || p === undefined) return kNone;
  if (p < 0.001) return "< 0.001";
  return p > 0.995 ? "1" : p.toPrecision(2);
}
// "15 of 24, 43-79 %"
export function spoken(e: Estimate): string {
  return e ? `${e[0]} of ${e[1]}, ${range(e[2], e[3])} %` : "not run";
}

export const plural = (n: number, one: string, many = one + "s"): string => `${count(n)} ${n === 1 ? one : many}`;

// A word that a POSIX shell takes as one.
export function shellWord(text: string): string {
  return /^[\w@%+=:,./-]+$/.test(text) ? text : `'${text.replaceAll("'", `'\\''`)}'`;
}

// A link beside the page or on the disk, never one that a browser would run; null if it is neither.
export function safeLink(path: string): string | null {
  if (path === "" || /[\u0000-\u001f]/.test(path)) return null;
  const encoded = path.split("/").map(encodeURIComponent).join("/");
  return path.startsWith("/") ? `file://${encoded}` : `./${encoded}`;
}
