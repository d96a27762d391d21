// The texts that are open: models of the editor, what of them is saved, what became of them on the disk.
import { kLanguage, monaco } from "./monaco";

type Model = monaco.editor.ITextModel;
export interface Text { path: string; model: Model; saved: number; isNew: boolean }

export class Texts {
  readonly all = new Map<string, Text>();
  add(path: string, uri: string, text: string, isNew: boolean): Text {
    const known = this.all.get(path);
    if (known) {
      // Taken from the disk once more: an edit that can be undone.
      known.model.pushEditOperations([], [{ range: known.model.getFullModelRange(), text }], () => null);
      known.saved = known.model.getAlternativeVersionId();
      known.isNew = isNew;
      return known;
    }
    const model = monaco.editor.createModel(text, kLanguage, monaco.Uri.parse(uri));
    model.updateOptions({ tabSize: 2, insertSpaces: true });
    const made = { path, model, saved: model.getAlternativeVersionId(), isNew };
    this.all.set(path, made);
    return made;
  }
  isChanged(text: Text): boolean { return text.isNew ? text.model.getValueLength() > 0 : text.model.getAlternativeVersionId() !== text.saved; }
  anyChanged(): boolean { return [...this.all.values()].some((text) => this.isChanged(text)); }
  ofModel(model: Model | null): Text | undefined { return [...this.all.values()].find((text) => text.model === model); }
  // What the program has to know that the disk does not.
  unsaved(): Record<string, string> {
    const out: Record<string, string> = {};
    for (const text of this.all.values()) if (text.isNew || this.isChanged(text)) out[text.path] = text.model.getValue();
    return out;
  }
}
