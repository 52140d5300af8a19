#pragma once
#include <cstddef>
#include <cstring>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace limcycle {

/// Messages between ranks (RankMessage::kind). Each rank except 0 sends `last` once, with its Ending, and then nothing.
enum RankWord : int {
  word_ready = 1,  ///< to rank 0: number of threads, identity of the sweep
  word_points,     ///< from rank 0: seconds after which to return the rest, points to compute
  word_rows,       ///< to rank 0: FinishedPoints
  word_last,       ///< to rank 0: exit code, error message
  word_end         ///< from rank 0: no more work
};

/// Appends numbers to a message.
template <class Number>
void pack(std::string& into, const Number* numbers, std::size_t count) {
  into.append(reinterpret_cast<const char*>(numbers), count * sizeof(Number));
}

/// Reads them back. Throws std::logic_error if the message is too short.
class Unpacking {
 public:
  explicit Unpacking(const std::string& from) : from_(from) {}

  template <class Number>
  std::vector<Number> numbers(std::size_t count) {
    if ((from_.size() - at_) / sizeof(Number) < count) throw std::logic_error("ranks: a message is too short");
    std::vector<Number> all(count);
    if (count > 0) std::memcpy(all.data(), from_.data() + at_, count * sizeof(Number));
    at_ += count * sizeof(Number);
    return all;
  }

  template <class Number>
  Number number() {
    return numbers<Number>(1).front();
  }

  std::string rest() { return from_.substr(std::exchange(at_, from_.size())); }

 private:
  const std::string& from_;
  std::size_t at_ = 0;
};

}  // namespace limcycle
