#include "limcycle/cases/loader/data/data_file.hpp"

#include <filesystem>
#include <fstream>

#include "limcycle/cases/loader/case.hpp"

namespace limcycle::case_file {
namespace {

constexpr std::uintmax_t largest_data_file = std::uintmax_t{1} << 26;

}  // namespace

std::string path_of_data(const Section& section, const std::string& name) {
  if (name.empty()) throw section.error("file", "must be the name of a file");
  std::string path = section.document().beside(name);
  std::error_code failed;
  if (!std::filesystem::exists(path, failed)) throw section.error("file", "no such file: " + path);
  if (!std::filesystem::is_directory(path, failed) && !std::filesystem::is_regular_file(path, failed))
    throw section.error("file", "must be a file that can be read twice, not a device or a pipe");
  return path;
}

std::string digest_of_data(const std::string& path, const std::function<InputError(const std::string&)>& error) {
  std::error_code failed;
  if (std::filesystem::file_size(path, failed) > largest_data_file && !failed)
    throw error("is larger than 64 MiB, the limit for measured data");
  std::ifstream in(path, std::ios::binary);
  return limcycle::sha256(std::string{std::istreambuf_iterator<char>(in), {}});
}

DataFile::DataFile(const Section& section, const std::string& name)
    : csv(path_of_data(section, name)),
      sha256(digest_of_data(csv.file(), [this](const std::string& rule) { return csv.error(rule); })) {}

double read_scale(const std::optional<Section>& scale, std::string_view column) {
  const auto factor = scale ? scale->find(column) : std::nullopt;
  if (!factor) return 1.0;
  const double value = read_number(*factor);
  if (value == 0.0) throw factor->error("must not be 0");
  return value;
}

}  // namespace limcycle::case_file
