#include "limcycle/cli/ranks/rank_job.hpp"

#include <algorithm>
#include <chrono>
#include <optional>
#include <thread>
#include <utility>

#include "limcycle/cli/interrupt.hpp"
#include "limcycle/cli/ranks/rank_words.hpp"

namespace limcycle {
namespace {

using std::chrono::microseconds;

constexpr auto patience_at_end = microseconds(1'000'000);  // after which a rank that does not end is given up

}  // namespace

RankJob& rank_job() {
  static RankJob job{false, std::vector<bool>(static_cast<std::size_t>(rank_count()), false)};
  return job;
}

bool all_others_left() { return std::ranges::count(rank_job().left, true) >= rank_count() - 1; }

void say_end() {
  if (std::exchange(rank_job().end_said, true)) return;
  for (int other = 1; other < rank_count(); ++other) send_to_rank({other, word_end, {}});
}

Ending hear_last(const RankMessage& message) {
  rank_job().left[static_cast<std::size_t>(message.other)] = true;
  Unpacking from(message.content);
  const int code = from.number<int>();
  return {code, from.rest()};
}

Ending end_ranks(const Ending& ending) {
  if (rank_count() == 1) {
    leave_ranks(ending.code);
    return {};
  }
  const bool writer = rank() == 0;
  if (writer) {
    say_end();
  } else {
    std::string content;
    pack(content, &ending.code, 1);
    if (!ending.message.empty()) content += rank_name() + ": " + ending.message;
    send_to_rank({0, word_last, std::move(content)});
  }
  Ending of_others;
  std::optional<std::chrono::steady_clock::time_point> until;
  while (writer ? !all_others_left() : !rank_job().end_said) {
    while (const auto message = message_from_ranks()) {
      if (message->kind == word_end) rank_job().end_said = true;
      if (message->kind != word_last) continue;
      if (const Ending other = hear_last(*message); of_others.message.empty()) of_others = other;
    }
    // A writer that failed and a rank asked to stop wait for a limited time. The others end when the last one does.
    if (!until && (interrupted() || (writer && !ending.message.empty())))
      until = std::chrono::steady_clock::now() + (writer ? patience_at_end : 10 * patience_at_end);
    if (until && std::chrono::steady_clock::now() > *until) abort_ranks(ending.code);
    std::this_thread::sleep_for(microseconds(5000));
  }
  leave_ranks(writer ? ending.code : 0);
  return of_others;
}

}  // namespace limcycle
