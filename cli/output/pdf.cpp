#include "limcycle/cli/output/pdf.hpp"

#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <string>
#include <vector>

#include "limcycle/cli/output/write_all.hpp"

namespace limcycle {
namespace {

constexpr const char* converter = "rsvg-convert";

/// A file in memory, closed at the end.
class MemoryFile {
 public:
  MemoryFile() : file_(memfd_create("limcycle", MFD_CLOEXEC)) {}
  ~MemoryFile() {
    if (file_ >= 0) close(file_);
  }
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;
  int id() const { return file_; }

  bool fill(std::string_view bytes) const { return write_all(file_, bytes) && lseek(file_, 0, SEEK_SET) == 0; }

  std::string contents() const {
    std::string bytes;
    char part[1 << 16];
    if (lseek(file_, 0, SEEK_SET) != 0) return bytes;
    for (ssize_t n = 0; (n = read(file_, part, sizeof part)) > 0;) bytes.append(part, static_cast<std::size_t>(n));
    return bytes;
  }

 private:
  int file_;
};

/// The environment with the date of the document, which would be that of today.
std::vector<std::string> without_date() {
  std::vector<std::string> list{"SOURCE_DATE_EPOCH=0"};
  for (char** one = environ; *one != nullptr; ++one)
    if (std::string_view(*one).substr(0, 18) != "SOURCE_DATE_EPOCH=") list.emplace_back(*one);
  return list;
}

std::vector<char*> pointers_to(std::vector<std::string>& list) {
  std::vector<char*> pointers;
  pointers.reserve(list.size() + 1);
  for (auto& one : list) pointers.push_back(one.data());
  pointers.push_back(nullptr);
  return pointers;
}

/// Exit code of the converter, which reads `in` and writes to `out`; -1 if it cannot be started.
int converted(std::vector<std::string> words, int in, int out) {
  std::vector<std::string> settings = without_date();
  posix_spawn_file_actions_t files;
  if (posix_spawn_file_actions_init(&files) != 0) return -1;
  pid_t child = 0;
  const bool started =
      posix_spawn_file_actions_adddup2(&files, in, STDIN_FILENO) == 0 &&
      posix_spawn_file_actions_adddup2(&files, out, STDOUT_FILENO) == 0 &&
      posix_spawnp(&child, converter, &files, nullptr, pointers_to(words).data(), pointers_to(settings).data()) == 0;
  posix_spawn_file_actions_destroy(&files);
  if (!started) return -1;
  int status = 0;
  while (waitpid(child, &status, 0) < 0)
    if (errno != EINTR) return -1;
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

}  // namespace

bool makes_pdf() {
  const MemoryFile in, out;
  return in.id() >= 0 && out.id() >= 0 && converted({converter, "--version"}, in.id(), out.id()) == 0;
}

std::optional<std::string> pdf_of(std::string_view svg) {
  const MemoryFile in, out;
  if (in.id() < 0 || out.id() < 0 || !in.fill(svg)) return std::nullopt;
  if (converted({converter, "--format=pdf"}, in.id(), out.id()) != 0) return std::nullopt;
  std::string pdf = out.contents();
  return pdf.empty() ? std::nullopt : std::optional(std::move(pdf));
}

}  // namespace limcycle
