#include "limcycle/cases/loader/signal_sum.hpp"

#include <cctype>
#include <charconv>
#include <cmath>

namespace limcycle::case_file {
namespace {

bool is_letter(char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0 || c == '_'; }
bool is_digit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }

/// sum = [sign] term {sign term}; term = [number *] name [. name or number].
class SumReader {
 public:
  SumReader(const Place& place, std::string_view text) : place_(place), text_(text) {}

  SignalSum read() {
    SignalSum sum;
    double sign = 1.0;
    if (next() == '-' || next() == '+') sign = take() == '-' ? -1.0 : 1.0;
    for (;;) {
      sum.push_back(term(sign));
      const char c = next();
      if (c == '\0') return sum;
      if (c != '+' && c != '-') throw refuse("a sign between two signals is missing");
      sign = take() == '-' ? -1.0 : 1.0;
    }
  }

 private:
  [[nodiscard]] InputError refuse(const std::string& what) const {
    return place_.error("must be a sum of signals: " + what, R"(such as "r - axis.y" or "2.0*a - b")");
  }

  char next() {
    while (at_ < text_.size() && text_[at_] == ' ') ++at_;
    return at_ < text_.size() ? text_[at_] : '\0';
  }
  char take() { return text_[at_++]; }

  Term term(double sign) {
    Term term{sign, {}, {}};
    if (is_digit(next()) || next() == '.') {
      double number = 0.0;
      const auto [end, fault] = std::from_chars(text_.data() + at_, text_.data() + text_.size(), number);
      if (fault != std::errc() || !std::isfinite(number)) throw refuse("a factor is no number");
      at_ = static_cast<std::size_t>(end - text_.data());
      if (next() != '*')
        throw refuse("a factor is followed by * and a signal; a number alone is a block of kind constant");
      take();
      term.factor = sign * number;
    }
    if (!is_letter(next())) throw refuse("a signal is missing");
    term.block = word();
    if (at_ < text_.size() && text_[at_] == '.') {
      take();
      term.output = word();
      if (term.output.empty()) throw refuse("the name of an output is missing after the dot");
    }
    return term;
  }

  std::string word() {
    const std::size_t begin = at_;
    while (at_ < text_.size() && (is_letter(text_[at_]) || is_digit(text_[at_]))) ++at_;
    return std::string(text_.substr(begin, at_ - begin));
  }

  const Place& place_;
  std::string_view text_;
  std::size_t at_ = 0;
};

}  // namespace

SignalSum read_signal_sum(const Place& place) {
  const std::string text = read_string(place);
  return SumReader(place, text).read();
}

}  // namespace limcycle::case_file
