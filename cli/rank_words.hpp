#pragma once
#include <cstddef>
#include <cstring>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace limcycle {

/// What ranks say to each other (RankMessage::kind). Each rank but 0 says `last` once, with its Ending, and nothing
/// after it.
enum RankWord : int {
  word_ready = 1,  ///< to rank 0: number of threads, identity of the sweep
  word_points,     ///< from rank 0: seconds after which to give the rest back, points to compute
  word_rows,       ///< to rank 0: FinishedPoints
  word_last,       ///< to rank 0: exit code, complaint
  word_end         ///< from rank 0: nothing more is to be done
};

/// Numbers into a message, one after another.
template <class Number>
void pack(std::string& into, const Number* numbers, std::size_t count) {
  into.append(reinterpret_cast<const char*>(numbers), count * sizeof(Number));
}

/// And out of it. Throws std::logic_error where it is too short.
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
