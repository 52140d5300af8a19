"""The examples of docs/python.md are run, and so are those of the package."""

import doctest
import inspect
import os
import re
import unittest

import limcycle
from common import SOURCES


class Page(unittest.TestCase):
    def test_its_examples_give_what_it_shows(self):
        text = (SOURCES / "docs" / "python.md").read_text(encoding="utf-8")
        self.addCleanup(os.chdir, os.getcwd())
        os.chdir(SOURCES)  # where the examples find the cases
        examples = re.sub(r"^```.*$", "", text, flags=re.MULTILINE)  # a fence is not output
        test = doctest.DocTestParser().get_doctest(examples, {}, "docs/python.md", "docs/python.md", 0)
        self.assertGreater(len(test.examples), 15)
        said = []
        failed = doctest.DocTestRunner().run(test, out=said.append).failed
        self.assertEqual(failed, 0, "".join(said))

    def test_it_names_every_function(self):
        text = (SOURCES / "docs" / "python.md").read_text(encoding="utf-8")
        for name in [*limcycle.__all__, "map"]:
            if inspect.isfunction(getattr(limcycle, name)):
                self.assertRegex(text, rf"\b{name}\(")


if __name__ == "__main__":
    unittest.main()
