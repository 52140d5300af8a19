#pragma once
#include <optional>
#include <string>
#include <string_view>

#include "limcycle/cases/loader/csv_reader.hpp"
#include "limcycle/cases/loader/section.hpp"

namespace limcycle::case_file {

/// A file of numbers on which the loop of a case rests, open for reading, and the digest of its bytes.
struct DataFile {
  CsvReader csv;
  std::string sha256;

  /// The file of this name that the key `file` of a section names, of at most 64 MiB. Throws InputError.
  DataFile(const Section& section, const std::string& name);
};

/// Factor on a column of such a file: the number of this name in the section's table `scale`, 1 without it. Throws
/// InputError if it is 0.
double read_scale(const std::optional<Section>& scale, std::string_view column);

}  // namespace limcycle::case_file
