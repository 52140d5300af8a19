#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "limcycle/cases/loader/case.hpp"
#include "limcycle/cases/loader/text/value.hpp"

namespace limcycle::case_file {
namespace {

[[noreturn]] void refuse(const std::string& file, const std::string& rule, int line = 0) {
  throw InputError(
      {.file = file, .line = line, .override = {}, .key = {}, .value = {}, .rule = rule, .suggestion = {}});
}

int line_of(std::string_view text, std::size_t position) {
  return 1 + static_cast<int>(std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(position), '\n'));
}

}  // namespace

void check_text(std::string_view text, const std::string& file) {
  if (text.find_first_not_of(" \t\r\n") == std::string_view::npos)
    refuse(file, "the file is empty: a case needs at least [loop]", 1);
  if (const auto nul = text.find('\0'); nul != std::string_view::npos)
    refuse(file, "not a text file (it holds a zero byte): a case file is TOML in UTF-8", line_of(text, nul));
  std::size_t valid = 0;
  if (!is_utf8(text, valid)) refuse(file, "not a text file in UTF-8: a case file is TOML", line_of(text, valid));
  if (const auto deep = nested_too_deep(text); deep != std::string_view::npos)
    refuse(file, "nested too deeply for a case", line_of(text, deep));
}

std::string read_text(const std::string& file) {
  if (file.empty()) refuse("''", "the name of the case file is empty");
  std::error_code failed;
  const auto status = std::filesystem::status(file, failed);
  if (!std::filesystem::exists(status))
    refuse(file, failed && failed != std::errc::no_such_file_or_directory ? "cannot be read: " + failed.message()
                                                                          : "no such file");
  if (std::filesystem::is_directory(status)) refuse(file, "is a directory, not a case file");
  errno = 0;
  std::ifstream in(file, std::ios::binary);
  if (!in) refuse(file, std::string("cannot be read: ") + std::strerror(errno));
  // The size reported by the file system is not used: a pipe has none, and a device has no end.
  std::string text(largest_case_file + 1, '\0');
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (in.bad()) refuse(file, "cannot be read");
  text.resize(static_cast<std::size_t>(in.gcount()));
  if (text.size() > largest_case_file) refuse(file, "is larger than 1 MiB, the limit for a case file");
  check_text(text, file);
  return text;
}

}  // namespace limcycle::case_file
