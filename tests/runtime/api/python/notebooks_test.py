"""The notebooks of examples/notebooks, run cell by cell as a kernel would; what they show is what is stored in them.

VLAPROBE_UPDATE_GOLDEN=1 stores what they show now.
"""

import ast
import base64
import contextlib
import io
import json
import os
import unittest

from common import SOURCE, Case

FOLDER = os.path.join(SOURCE, "examples", "notebooks")


def lines(text: str) -> list:
    # Of no machine: files of the tree by their names within it.
    return text.replace(SOURCE + "/", "").splitlines(keepends=True)


def shown(value) -> dict:
    """What a notebook stores of a value: the forms that it has of itself."""
    data = {"text/plain": lines(repr(value))}
    html = getattr(value, "_repr_html_", lambda: None)()
    png = getattr(value, "_repr_png_", lambda: None)()
    if html is not None:
        data["text/html"] = lines(html)
    if png is not None:
        # Of the picture itself: an array's numbers say nothing.
        data = {"text/plain": [f"<{type(value).__name__}>"], "image/png": base64.b64encode(png).decode() + "\n"}
    return data


def run_cell(cell: dict, number: int, names: dict) -> None:
    source = "".join(cell["source"])
    tree = ast.parse(source)
    last = tree.body.pop() if tree.body and isinstance(tree.body[-1], ast.Expr) else None
    said, outputs = io.StringIO(), []
    with contextlib.redirect_stdout(said):
        exec(compile(tree, f"cell {number}", "exec"), names)
        value = eval(compile(ast.Expression(last.value), f"cell {number}", "eval"), names) if last else None
    if said.getvalue():
        outputs.append({"name": "stdout", "output_type": "stream", "text": lines(said.getvalue())})
    if value is not None:
        outputs.append({"data": shown(value), "execution_count": number, "metadata": {}, "output_type": "execute_result"})
    cell["execution_count"], cell["outputs"] = number, outputs


class NotebooksTest(Case):
    def run_book(self, name: str) -> None:
        path = os.path.join(FOLDER, name)
        with open(path) as file:
            text = file.read()
        book = json.loads(text)
        self.addCleanup(os.chdir, os.getcwd())
        os.chdir(self.folder())
        names: dict = {"__name__": "__main__"}
        code = [cell for cell in book["cells"] if cell["cell_type"] == "code"]
        stored = json.loads(json.dumps(code))
        for number, cell in enumerate(code, 1):
            run_cell(cell, number, names)
        if os.environ.get("VLAPROBE_UPDATE_GOLDEN"):
            with open(path, "w") as file:
                file.write(json.dumps(book, indent=1, ensure_ascii=False, sort_keys=True) + "\n")
            return
        self.maxDiff = 3000
        for number, (cell, before) in enumerate(zip(code, stored), 1):
            self.assertEqual(cell["outputs"], before["outputs"], f"{name}, cell {number}")
        self.assertTrue(any(cell["outputs"] for cell in code))

    def test_first_task(self):
        self.run_book("first_task.ipynb")

    def test_own_policy(self):
        self.run_book("own_policy.ipynb")

    def test_reading_results(self):
        self.run_book("reading_results.ipynb")

    def test_no_notebook_is_left_out(self):
        told = {f"{name[5:]}.ipynb" for name in dir(self) if name.startswith("test_")}
        self.assertTrue({name for name in os.listdir(FOLDER) if name.endswith(".ipynb")} <= told)


if __name__ == "__main__":
    unittest.main()
