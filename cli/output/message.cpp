#include "limcycle/cli/output/message.hpp"

#include <iostream>

#include "limcycle/cases/loader/text/printable.hpp"
#include "limcycle/cli/interrupt.hpp"
#include "limcycle/questions/asking/words.hpp"

namespace limcycle {
namespace {

constexpr std::size_t longest_message = 2000;

std::string cause_of(const CommonFlags& flags) {
  return cause_in_words(interrupted_by_time() ? flags.time_limit : 0.0);
}

}  // namespace

void tell(const CommonFlags& flags, const std::string& message) {
  if (!flags.quiet) std::cerr << "limcycle: " + one_line(message, longest_message) + "\n" << std::flush;
}

void tell_cut_short(const CommonFlags& flags, Status status, const std::string& kept) {
  if (status != Status::interrupted) return;
  tell(flags, cause_of(flags) + "; " + kept);
}

std::string first_line(const CommonFlags& flags, Status status) { return first_line(status, cause_of(flags)); }

std::string page_line(const std::string& file) { return "\nreport: " + one_line(file, longest_message) + "\n"; }

}  // namespace limcycle
