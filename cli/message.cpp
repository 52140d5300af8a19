#include "limcycle/cli/message.hpp"

#include <cctype>
#include <iostream>

#include "limcycle/cases/loader/printable.hpp"
#include "limcycle/cli/interrupt.hpp"
#include "limcycle/reports/number.hpp"

namespace limcycle {
namespace {

constexpr std::size_t longest_message = 2000;

std::string limit_in_words(const CommonFlags& flags) {
  return "time limit of " + shortest(flags.time_limit) + " s reached";
}

}  // namespace

void tell(const CommonFlags& flags, const std::string& message) {
  if (!flags.quiet) std::cerr << "limcycle: " + one_line(message, longest_message) + "\n" << std::flush;
}

void tell_cut_short(const CommonFlags& flags, Status status, const std::string& kept) {
  if (status != Status::interrupted) return;
  tell(flags, (interrupted_by_time() ? limit_in_words(flags) : "interrupted") + "; " + kept);
}

std::string first_line(const CommonFlags& flags, Status status) {
  if (status != Status::interrupted) return {};
  std::string cause = interrupted_by_time() ? limit_in_words(flags) : "interrupted";
  cause.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(cause.front())));
  return cause + ": this result is incomplete.\n\n";
}

std::string page_line(const std::string& file) { return "\nreport: " + one_line(file, longest_message) + "\n"; }

}  // namespace limcycle
