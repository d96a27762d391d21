"""The recipes of the package's README, run one after the other as a reader would."""

import os
import re
import unittest

from common import SOURCE, Case


class ReadmeTest(Case):
    def test_every_recipe_runs(self):
        folder = self.folder()
        for name in ("suite", "tests", "dsl", "assets"):
            os.symlink(os.path.join(SOURCE, name), os.path.join(folder, name))
        self.addCleanup(os.chdir, os.getcwd())
        os.chdir(folder)
        with open(os.path.join(SOURCE, "runtime", "api", "python", "README.md")) as file:
            recipes = re.findall(r"```python\n(.*?)```", file.read(), re.DOTALL)
        self.assertGreater(len(recipes), 6)
        names = {}
        for number, recipe in enumerate(recipes):
            with self.subTest(recipe=number):
                exec(compile(recipe, f"README.md, recipe {number}", "exec"), names)
        self.assertEqual(names["run"].results().counts(), {"carrot_on_plate": (0, 2)})
        self.assertEqual(names["expert"].results().counts(), {"carrot_on_plate": (2, 2)})


if __name__ == "__main__":
    unittest.main()
