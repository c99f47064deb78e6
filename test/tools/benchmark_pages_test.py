#!/usr/bin/python3
"""What scripts/benchmark writes into the pages: exponents, curves, tables, and nothing else of a page."""

import os
import pathlib
import sys
import tempfile
import unittest

SOURCE = pathlib.Path(os.environ["SOURCE"])
sys.path.insert(0, str(SOURCE / "benchmark"))

# pylint: disable=wrong-import-position
import growth
import pages

TIMES = {
    "refine/joint/10": 7.0,
    "refine/1000": 2e-3 * 10**1.5,
    "refine/100": 2e-3,
    "refine/100/other": 9.0,
    "refine/10": 2e-3 * 10**-1.5,
}


class Growth(unittest.TestCase):
    def test_takes_the_sizes_of_one_benchmark_alone(self):
        self.assertEqual([size for size, _ in growth.series(TIMES, "refine")], [10, 100, 1000])

    def test_finds_the_exponent_of_a_power(self):
        exponent, factor = growth.fitted(growth.series(TIMES, "refine"))
        self.assertAlmostEqual(exponent, 1.5)
        self.assertAlmostEqual(factor * 100**exponent, 2e-3)

    def test_refuses_a_single_size(self):
        with self.assertRaises(ValueError):
            growth.fitted([(10, 1.0), (10, 2.0)])

    def test_draws_the_same_numbers_as_the_same_file(self):
        with tempfile.TemporaryDirectory() as folder:
            pictures = [pathlib.Path(folder, name) for name in ("a.svg", "b.svg")]
            for picture in pictures:
                growth.draw([(growth.series(TIMES, "refine"), "samples"), ([(1, 1.0), (2, 4.0)], "coils")], picture)
            first, second = (picture.read_text(encoding="utf-8") for picture in pictures)
        self.assertIn("</svg>", first)
        self.assertEqual(first, second)


class Pages(unittest.TestCase):
    def test_leaves_the_rest_of_a_page_as_it_is(self):
        page = f"before\n{pages.BEGIN}\nold\n{pages.END}\nafter\n"
        new = pages.replaced(page, "new\n")
        self.assertEqual(new, f"before\n{pages.BEGIN}\nnew\n{pages.END}\nafter\n")
        self.assertEqual(pages.replaced(new, "new"), new)

    def test_refuses_a_page_without_its_place(self):
        for page in ("words", f"{pages.END}\n{pages.BEGIN}", f"{pages.BEGIN}{pages.BEGIN}{pages.END}"):
            with self.assertRaises(ValueError):
                pages.replaced(page, "new")

    def test_has_its_place_in_the_pages_that_are_there(self):
        for page in ("README.md", "doc/performance.md"):
            text = (SOURCE / page).read_text(encoding="utf-8")
            self.assertIn("Measured on ", text.partition(pages.BEGIN)[2].partition(pages.END)[0], page)

    def test_makes_a_table(self):
        self.assertEqual(pages.table(("what", "figure"), [("reading", "6")]),
                         "| what | figure |\n| --- | --- |\n| reading | 6 |")

    def test_names_the_processor(self):
        self.assertTrue(pages.processor())


if __name__ == "__main__":
    unittest.main()
