#include "limcycle/cli/output.hpp"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>

#include "limcycle/cases/printable.hpp"
#include "limcycle/cli/colour.hpp"
#include "limcycle/cli/ranks.hpp"

namespace limcycle {
namespace {

bool written_to(std::ostream& out, std::string_view document) {
  return static_cast<bool>(out.write(document.data(), static_cast<std::streamsize>(document.size())).flush());
}

/// Puts `document` in place of a file only when it is complete on the disk: a write that fails leaves what stood there.
bool replaced(const std::string& path, std::string_view document) {
  namespace fs = std::filesystem;
  std::error_code failed;
  if (fs::exists(path, failed) && !fs::is_regular_file(path, failed)) {  // devices and pipes are written, not replaced
    std::ofstream out(path, std::ios::binary);
    return written_to(out, document);
  }
  const fs::path target = fs::weakly_canonical(path, failed);  // a link stays a link
  if (failed) return false;
  const fs::path draft = target.string() + ".part" + std::to_string(getpid());
  std::ofstream out(draft, std::ios::binary | std::ios::trunc);
  bool done = written_to(out, document);
  out.close();
  done = done && out;
  if (done) {
    if (fs::exists(target, failed)) fs::permissions(draft, fs::status(target, failed).permissions(), failed);
    fs::rename(draft, target, failed);
    if (failed) errno = failed.value();
    done = !failed;
  }
  if (!done) {
    const int reason = errno;
    std::error_code ignored;
    fs::remove(draft, ignored);
    errno = reason;
  }
  return done;
}

/// The one name that all ways to write it lead to, through links; the file need not exist. Empty where that fails.
std::filesystem::path full_name(const std::string& path) {
  std::error_code failed;
  const auto name = std::filesystem::weakly_canonical(std::filesystem::absolute(path, failed), failed);
  return failed ? std::filesystem::path() : name;
}

/// Do both names mean one file, which exists or not? Devices may be named twice.
bool same_file(const std::string& one, const std::string& other) {
  namespace fs = std::filesystem;
  if (one == "-" || other == "-") return one == other;
  std::error_code failed;
  if (fs::exists(one, failed) && !fs::is_regular_file(one, failed)) return false;
  if (fs::equivalent(one, other, failed)) return true;
  const fs::path first = full_name(one);
  return !first.empty() && first == full_name(other);
}

/// 0, or the error that a document would meet: it is written beside the file, which it then replaces.
int cannot_be_replaced(const std::string& path) {
  namespace fs = std::filesystem;
  std::error_code failed;
  const auto status = fs::status(path, failed);
  if (fs::is_directory(status)) return EISDIR;
  // Devices and pipes are not opened before there is something to write.
  if (fs::exists(status) && !fs::is_regular_file(status)) return 0;
  if (fs::exists(status) && access(path.c_str(), W_OK) != 0) return errno;
  const fs::path folder = full_name(path).parent_path();
  return access(folder.c_str(), W_OK | X_OK) == 0 ? 0 : errno;
}

}  // namespace

Output::Output(const CommonFlags& flags) : json_(flags.json), csv_(flags.csv) {
  keep("the case file", flags.case_file);
  text_ = !flags.output.empty() ? flags.output : json_ == "-" || csv_ == "-" ? "" : "-";
  colours_ = text_ == "-" && colours_wanted(flags.color, STDOUT_FILENO);
  check_file("--output", flags.output);
  check_file("--json", flags.json);
  check_file("--csv", flags.csv);
}

void Output::keep(const std::string& what, const std::string& path) {
  if (path.empty() || path == "-") return;
  for (const auto& one : taken_)
    if (!one.flag.empty() && same_file(one.path, path)) throw refusal(one.flag + " " + one.path, "is " + what);
  taken_.push_back({{}, path, what});
}

void Output::check_file(const std::string& flag, const std::string& path) {
  if (path.empty() || rank() > 0) return;
  for (const auto& one : taken_)
    if (same_file(path, one.path)) throw refusal(flag + " " + path, "is " + one.what);
  taken_.push_back({flag, path, "where " + flag + " goes already"});
  if (path == "-") return;
  if (const int reason = cannot_be_replaced(path); reason != 0)
    throw refusal(flag + " " + path, std::string("cannot be written: ") + std::strerror(reason));
}

void Output::text(std::string_view document) {
  const std::string shown = printable(document);
  write(text_, colours_ ? coloured(shown) : shown);
}

void Output::write(const std::string& path, std::string_view document) {
  if (path.empty() || rank() > 0) return;
  errno = 0;
  // The text went through printable() before it was coloured.
  const bool raw = path == "-" && path != text_ && isatty(STDOUT_FILENO) == 1;
  const bool written = path != "-" ? replaced(path, document)
                       : raw       ? written_to(std::cout, printable(document))
                                   : written_to(std::cout, document);
  if (!written && failure_.empty())
    failure_ = "cannot write to " + (path == "-" ? "stdout" : path) +
               (errno != 0 ? std::string(": ") + std::strerror(errno) : "");
}

void Output::finish() {
  if (!failure_.empty()) throw OutputError(failure_);
}

}  // namespace limcycle
