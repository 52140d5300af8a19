"""The examples of docs/python.md are run, and so are those of the package; docs/library.md names what there is."""

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


class PublicHeaders(unittest.TestCase):
    """Of docs/library.md: each header declares its function, and every name of the module leads to one."""

    def rows(self):
        text = (SOURCES / "docs" / "library.md").read_text(encoding="utf-8")
        section = text[text.index("## Public headers"):text.index("## Versions")]
        cells = [re.findall(r"\|([^|]*)(?=\|)", line) for line in section.splitlines() if line.startswith("| ")]
        return [tuple(re.findall(r"`([^`]+)`", cell) for cell in row[1:]) for row in cells[1:]]

    def test_each_function_is_declared_where_it_says(self):
        rows = self.rows()
        self.assertGreater(len(rows), 15)
        for headers, functions, _ in rows:
            text = "".join((SOURCES / header).read_text(encoding="utf-8") for header in headers)
            for function in functions:
                with self.subTest(function):
                    self.assertRegex(text, rf"(?m)^[\w:<>,&* ]*\b{function}\(")

    def test_every_public_name_leads_to_one(self):
        named = {name for _, _, names in self.rows() for name in names}
        public = {*limcycle.__all__, "map"}
        self.assertLessEqual(named, public)
        questions = {name for name in public if inspect.isfunction(getattr(limcycle, name))}
        self.assertLessEqual(questions, named)
        for name in public - named:  # results, exceptions, and parts of them
            kind = getattr(limcycle, name)
            self.assertTrue(issubclass(kind, (limcycle.Record, Exception, tuple)), name)


if __name__ == "__main__":
    unittest.main()
