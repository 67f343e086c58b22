"""Tables say what they were given, in all three forms, whatever the labels hold."""

import csv
import io
import math
import unittest

import support  # noqa: F401  the import path

from analysis.table_file import Table, Value, csv_text, latex_table, latex_text, markdown_text

TABLE = Table(["scene", "method", "frames", "relmse", "mape"], ["scene", "a & b", "frames", "relMSE", ""],
              [["one", "50 % of_it", 12, Value(0.012345678901234567, 0.011, 0.014), Value(1)],
               ["one", 'x|y, "quoted"', 12, Value(1234.5), Value(2)],
               ["two", "{a}^b~$#\\", 12, Value(math.nan), Value(3)]], caption="what it is")


class TableTest(unittest.TestCase):
    def test_csv_has_every_digit_and_column(self) -> None:
        rows = list(csv.DictReader(io.StringIO(csv_text(TABLE))))
        self.assertEqual(float(rows[0]["relmse"]), 0.012345678901234567)
        self.assertEqual([rows[0]["relmse_low"], rows[0]["relmse_high"], rows[1]["relmse_low"], rows[2]["relmse"]],
                         ["0.011", "0.014", "", ""])
        self.assertEqual([rows[1]["method"], rows[2]["method"], rows[0]["mape"]],
                         ['x|y, "quoted"', "{a}^b~$#\\", "1.0"])
        self.assertIn("\r\n", csv_text(TABLE))  # RFC 4180

    def test_markdown(self) -> None:
        lines = markdown_text(TABLE).splitlines()
        self.assertEqual([len(line) for line in lines[:5]], [len(lines[0])] * 5)
        self.assertIn("0.0123 [0.0110, 0.0140]", lines[2])
        self.assertIn(r"x\|y", lines[3])
        self.assertIn("1.23e+03", lines[3])
        self.assertTrue(lines[1].startswith("|-----") and lines[1].endswith("-:|"), lines[1])
        self.assertNotIn("mape", lines[0])
        self.assertEqual(lines[-1], "what it is")

    def test_latex(self) -> None:
        text = latex_table(TABLE)
        self.assertIn(r"\begin{tabular}{llrr}", text)
        self.assertIn(r"scene & a \& b & frames & relMSE \\", text)
        self.assertIn(r"one & 50 \% of\_it & 12 & $0.0123$ {\scriptsize$[0.0110,\,0.0140]$} \\", text)
        self.assertIn(r" & x\textbar{}y, ''quoted'' & 12 & $1.23\times 10^{3}$ \\", text.replace('"', "''"))
        self.assertIn(r"two & \{a\}\textasciicircum{}b\textasciitilde{}\$\#\textbackslash{} & 12 & -- \\", text)
        self.assertEqual([text.count(rule) for rule in (r"\toprule", r"\midrule", r"\bottomrule")], [1, 2, 1])
        for line in text.splitlines()[4:-2]:
            if "rule" not in line:
                self.assertEqual(line.replace(r"\&", "").count("&"), 3, line)

    def test_no_special_character_is_left(self) -> None:
        for character in "&%$#_{}~^\\<>|":
            self.assertNotEqual(latex_text(character), character)


if __name__ == "__main__":
    unittest.main()
