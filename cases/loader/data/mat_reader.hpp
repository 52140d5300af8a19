#pragma once
#include <memory>
#include <string>
#include <vector>

#include "limcycle/cases/loader/text/section.hpp"

namespace limcycle::case_file {

/// Variables of a MAT-file: of MATLAB's versions 4, 5, 7 and 7.3, or one that Octave wrote (save -v7).
class MatReader {
 public:
  /// The file that the key `file` of a section names, of at most 64 MiB. Throws InputError.
  explicit MatReader(const Section& section);

  /// Names of all variables, in the order of the file.
  const std::vector<std::string>& names() const { return names_; }
  const std::string& sha256() const { return sha256_; }

  /// A variable as a case would write it, at the line of `file`: rows of a matrix, or with `flat` the list of its
  /// numbers (a row or a column; complex ones as pairs). Throws InputError unless it is a full matrix of numbers, of at
  /// most `most_rows` rows, and of `longest_list` columns.
  Value read(const std::string& name, bool flat, std::size_t most_rows) const;

 private:
  InputError error(const std::string& what) const;

  Place key_;
  std::string file_, sha256_;
  std::shared_ptr<void> open_;
  std::vector<std::string> names_;
};

}  // namespace limcycle::case_file
