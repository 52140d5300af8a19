#pragma once
#include <fcntl.h>
#include <signal.h>
#include <unistd.h>

#include <chrono>
#include <sstream>
#include <thread>

#include "limcycle/tests/cli/program.hpp"
#include "limcycle/tests/setting.hpp"

namespace limcycle::test {

/// A command in the background, its output in files of the scratch folder; killed in the destructor if still running.
class Started {
 public:
  Started(const Scratch& scratch, const std::vector<std::string>& words) : scratch_(scratch) {
    const std::string out = scratch.file("started.out"), err = scratch.file("started.err");
    pid_ = fork();
    if (pid_ != 0) return;
    std::vector<char*> all;
    for (const auto& word : words) all.push_back(const_cast<char*>(word.c_str()));
    all.push_back(nullptr);
    dup2(open("/dev/null", O_RDONLY), STDIN_FILENO);
    dup2(open(out.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644), STDOUT_FILENO);
    dup2(open(err.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644), STDERR_FILENO);
    execvp(all.front(), all.data());
    _exit(127);
  }
  ~Started() {
    if (pid_ > 0) kill(pid_, SIGKILL);
  }
  Started(const Started&) = delete;
  Started& operator=(const Started&) = delete;

  pid_t pid() const { return pid_; }

  /// Waits until it catches the signal and has computed for `seconds` since, on any machine. False: not within five
  /// minutes, or it ended before.
  bool works_and_catches(int signal, double seconds) const {
    double since = -1.0;
    for (int tries = 0; tries < 30'000; ++tries) {
      const std::string status = proc("status"), caught = after(status, "SigCgt:");
      if (caught.empty() || after(status, "State:").starts_with("\tZ")) return false;
      if (since < 0.0 && (std::stoull(caught, nullptr, 16) >> (signal - 1) & 1) != 0) since = computed();
      if (since >= 0.0 && computed() >= since + seconds) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return false;
  }

  Ran wait() {
    int status = 0;
    waitpid(pid_, &status, 0);
    pid_ = -1;
    return {WIFEXITED(status) ? WEXITSTATUS(status) : 1000 + WTERMSIG(status), scratch_.get("started.out"),
            scratch_.get("started.err")};
  }

 private:
  static std::string after(const std::string& text, const std::string& key) {
    const auto at = text.find(key);
    return at == std::string::npos ? "" : text.substr(at + key.size());
  }
  std::string proc(const std::string& name) const {
    std::ifstream in("/proc/" + std::to_string(pid_) + "/" + name, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }
  /// CPU time of the process, s.
  double computed() const {
    const std::string text = proc("stat");
    std::istringstream fields(text.substr(text.rfind(')') + 1));  // the name may contain anything
    std::string skipped;
    for (int i = 3; i < 14; ++i) fields >> skipped;
    double user = 0.0, system = 0.0;
    fields >> user >> system;
    return (user + system) / static_cast<double>(sysconf(_SC_CLK_TCK));
  }

  const Scratch& scratch_;
  pid_t pid_ = -1;
};

/// Sends Ctrl-C to the program after `seconds` of computing; twice at once, as `timeout` and `mpirun` do.
inline Ran run_interrupted(const std::vector<std::string>& arguments, double seconds) {
  const Scratch scratch;
  std::vector<std::string> words{tested_program};
  words.insert(words.end(), arguments.begin(), arguments.end());
  Started program(scratch, words);
  if (program.works_and_catches(SIGINT, seconds)) {
    kill(program.pid(), SIGINT);
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    kill(program.pid(), SIGINT);
  }
  return program.wait();
}

}  // namespace limcycle::test
