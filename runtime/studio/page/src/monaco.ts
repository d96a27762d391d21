// Monaco with what its core can do, one worker, and our colours.
import * as monaco from "monaco-editor/esm/vs/editor/edcore.main.js";
import { isDark, token } from "../../../report/page/src/theme";

export { monaco };
export const kLanguage = "probe";

(self as unknown as { MonacoEnvironment: object }).MonacoEnvironment = { getWorker: () => new Worker(new URL("worker.js", location.href)) };

monaco.languages.register({ id: kLanguage, extensions: [".probe"] });
monaco.languages.setLanguageConfiguration(kLanguage, {
  comments: { lineComment: "#" },
  brackets: [["{", "}"], ["(", ")"], ["[", "]"]],
  autoClosingPairs: [{ open: "{", close: "}" }, { open: "(", close: ")" }, { open: "\"", close: "\"", notIn: ["string", "comment"] }],
  surroundingPairs: [{ open: "{", close: "}" }, { open: "(", close: ")" }, { open: "\"", close: "\"" }],
  wordPattern: /[A-Za-z_][A-Za-z0-9_]*|-?[0-9]+(?:\.[0-9]+)?[a-z]*/,
  indentationRules: { increaseIndentPattern: /\{[^}]*$/, decreaseIndentPattern: /^\s*\}/ },
});
// Until the program has said what every word is.
monaco.languages.setMonarchTokensProvider(kLanguage, {
  tokenizer: { root: [[/#.*$/, "comment"], [/"[^"]*"?/, "string"], [/-?\d+(\.\d+)?[a-z]*/, "number"]] },
});

export function setTheme(): void {
  const dark = isDark();
  const hex = (name: string): string => token(name).replace("#", "");
  const rule = (name: string, light: string, darker: string, fontStyle?: string): monaco.editor.ITokenThemeRule => ({ token: name, foreground: dark ? darker : light, ...(fontStyle ? { fontStyle } : {}) });
  monaco.editor.defineTheme("vlaprobe", {
    base: dark ? "vs-dark" : "vs",
    inherit: true,
    rules: [
      rule("comment", "5d6570", "9aa3ad"), rule("string", "1c6b43", "7fd0a2"), rule("number", "7a5200", "e7c067"), rule("keyword", "0b5a9c", "7cbcf2"),
      rule("class", "8a3a12", "f0a36f"), rule("type", "3d35a8", "b5adf5", "bold"), rule("namespace", "6c2f86", "d8a2e8"), rule("function", "0a6570", "6fcbd6"),
      rule("variable", "96214a", "f48aa8"), rule("parameter", "96214a", "f48aa8"), rule("enum", "4c5a12", "c1cf6a"), rule("enumMember", "4c5a12", "c1cf6a"),
      rule("macro", "6c2f86", "d8a2e8"), rule("interface", "3d35a8", "b5adf5"), rule("property", "1a1d21", "e8e9ea"),
    ],
    colors: { "editor.background": "#" + hex("--paper"), "editor.foreground": "#" + hex("--ink"), "editorLineNumber.foreground": "#" + hex("--soft"), "editorInlayHint.foreground": "#" + hex("--soft"), "editorInlayHint.background": "#" + hex("--tint"), "editorCodeLens.foreground": "#" + hex("--soft") },
  });
  monaco.editor.setTheme("vlaprobe");
}
