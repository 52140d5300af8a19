#pragma once
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

}  // namespace limcycle::case_file
