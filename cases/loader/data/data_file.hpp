#pragma once
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "limcycle/cases/loader/data/csv_reader.hpp"
#include "limcycle/cases/loader/text/section.hpp"

namespace limcycle::case_file {

/// A file of numbers on which the loop of a case rests, open for reading, and the digest of its bytes.
struct DataFile {
  CsvReader csv;
  std::string sha256;

  /// The file of this name that the key `file` of a section names, of at most 64 MiB. Throws InputError.
  DataFile(const Section& section, const std::string& name);
};

/// Where the file of this name is that the key `file` of a section names. It may be read twice. Throws InputError.
std::string path_of_data(const Section& section, const std::string& name);

/// SHA-256 of the bytes of a file of at most 64 MiB; throws `error("is larger than ...")` for another.
std::string digest_of_data(const std::string& path, const std::function<InputError(const std::string&)>& error);

/// Factor on a column of such a file: the number of this name in the section's table `scale`, 1 without it. Throws
/// InputError if it is 0.
double read_scale(const std::optional<Section>& scale, std::string_view column);

}  // namespace limcycle::case_file
