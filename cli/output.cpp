#include "limcycle/cli/output.hpp"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iostream>

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

}  // namespace

Output::Output(const CommonFlags& flags) : json_(flags.json), csv_(flags.csv) {
  const std::vector<std::pair<std::string, std::string>> named = {
      {"--output", flags.output}, {"--json", flags.json}, {"--csv", flags.csv}};
  for (std::size_t i = 0; i < named.size(); ++i)
    for (std::size_t k = 0; k < i; ++k)
      if (!named[i].second.empty() && named[i].second == named[k].second)
        throw refusal(named[i].first + " " + named[i].second, "is where " + named[k].first + " goes already");
  text_ = !flags.output.empty() ? flags.output : json_ == "-" || csv_ == "-" ? "" : "-";
  colours_ = text_ == "-" && colours_wanted(flags.color, STDOUT_FILENO);
  for (const auto& [flag, path] : named) check_file(flag, path);
}

Output::~Output() {
  std::error_code ignored;
  for (const auto& path : created_) std::filesystem::remove(path, ignored);
}

void Output::check_file(const std::string& flag, const std::string& path) {
  if (path.empty() || path == "-" || rank() > 0) return;
  std::error_code failed;
  const auto status = std::filesystem::status(path, failed);
  // Devices and pipes are not opened before there is something to write.
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status) &&
      !std::filesystem::is_directory(status))
    return;
  errno = 0;
  if (!std::ofstream(path, std::ios::app))
    throw refusal(flag + " " + path, std::string("cannot be written: ") + std::strerror(errno));
  if (!std::filesystem::exists(status)) created_.push_back(path);
}

void Output::text(std::string_view document) { write(text_, colours_ ? coloured(document) : std::string(document)); }

void Output::write(const std::string& path, std::string_view document) {
  if (path.empty() || rank() > 0) return;
  errno = 0;
  const bool written = path == "-" ? written_to(std::cout, document) : replaced(path, document);
  if (written) std::erase(created_, path);
  if (!written && failure_.empty())
    failure_ = "cannot write to " + (path == "-" ? "stdout" : path) +
               (errno != 0 ? std::string(": ") + std::strerror(errno) : "");
}

void Output::finish() {
  if (!failure_.empty()) throw OutputError(failure_);
}

}  // namespace limcycle
