#pragma once
#include <sys/wait.h>

#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <vector>

#include "limcycle/tests/setting.hpp"

namespace limcycle::test {

/// A temporary folder for one test, removed at the end.
class Scratch {
 public:
  Scratch()
      : path_(std::filesystem::temp_directory_path() / ("limcycle-test-" + std::to_string(std::random_device{}()))) {
    std::filesystem::create_directories(path_);
  }
  ~Scratch() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;

  std::string file(const std::string& name) const { return (path_ / name).string(); }
  std::string put(const std::string& name, std::string_view bytes) const {
    std::ofstream(file(name), std::ios::binary).write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    return file(name);
  }
  std::string get(const std::string& name) const {
    std::ifstream in(file(name), std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }

 private:
  std::filesystem::path path_;
};

/// Exit code and output of the program.
struct Ran {
  int code = -1;  ///< exit code; 1000 + signal if it was killed
  std::string out, err;
};

inline std::string quoted(const std::string& argument) {
  std::string text = "'";
  for (const char c : argument) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

/// Runs the real program. `redirect`: replaces the capture of stdout, such as "> /dev/full"; `by`: a program that runs
/// it.
inline Ran run(const std::vector<std::string>& arguments, const std::string& redirect = {},
               const std::string& by = {}) {
  const Scratch scratch;
  std::string command = by + quoted(tested_program);
  for (const auto& argument : arguments) command += ' ' + quoted(argument);
  command +=
      (redirect.empty() ? " > " + quoted(scratch.file("out")) : ' ' + redirect) + " 2> " + quoted(scratch.file("err"));
  const int status = std::system((command + " < /dev/null").c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status), scratch.get("out"), scratch.get("err")};
}

/// One space for any run of white space, so that wrapped cells and lines can be compared.
inline std::string squeezed(const std::string& text) {
  std::string out;
  for (const char c : text)
    if (std::isspace(static_cast<unsigned char>(c)) == 0)
      out += c;
    else if (!out.ends_with(' '))
      out += ' ';
  return out;
}

inline std::string shipped(const std::string& name) { return std::string(LIMCYCLE_SOURCE_DIR) + "/cases/" + name; }

}  // namespace limcycle::test
