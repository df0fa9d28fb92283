// SPDX-License-Identifier: GPL-2.0-or-later
// Text of numbers in named columns, as programs save it: Yade's plot.saveDataTxt and export.text, and what people write
// themselves.
//   - lines before the numbers may begin with '#'; the last of them names the columns, `#` before it or not
//     (`# t\t\tTx`, `t,Tx`, `#format x_y_z_r`)
//   - columns are divided as their names are: by semicolons if there is one among the names, else by commas if there is
//     one, else by blanks or tabs
//   - numbers have decimal points, or decimal commas where no comma divides the columns; one kind a file, no marks
//     between thousands
//   - empty lines and lines of '#' among the numbers are skipped
// `nan` is read as such: plot.addData leaves it where a call gave no value; an empty field between commas is one too.
// Who takes a column decides about it.
//
// Errors: BadInput with file and line for a missing or packed file, no line of names, no numbers, a line with another
// number of fields, a field that is no number.
#pragma once

#include <string>
#include <vector>

namespace vielto {

struct ColumnText {
  std::string path;
  std::vector<std::string> names;
  std::vector<std::vector<double>> rows;
  std::vector<int> lines;  // of each row in the file

  // Errors: BadInput if there is no such column; it lists those that there are.
  std::size_t column(const std::string& name) const;
};

ColumnText read_column_text(const std::string& path);

}  // namespace vielto
