#include "limcycle/analysis/study/balance/roots/within_data.hpp"

#include <algorithm>

#include "limcycle/analysis/short_number.hpp"
#include "limcycle/models/measured/plants_of_loop.hpp"

namespace limcycle {

std::vector<SearchBox> within_data(const Loop& loop, const SearchBox& box) {
  std::vector<SearchBox> boxes{box};
  for (const MeasuredPart& part : loop.measured) {
    std::vector<SearchBox> cut;
    for (const SearchBox& one : boxes) {
      for (const auto& [from, to] : part.response->ranges()) {
        SearchBox inner = one;
        inner.frequency_min = std::max(inner.frequency_min, from);
        inner.frequency_max = std::min(inner.frequency_max, to);
        if (inner.frequency_max > inner.frequency_min) cut.push_back(inner);
      }
    }
    boxes = std::move(cut);
  }
  return boxes;
}

std::vector<std::string> data_limits(const Loop& loop, const SearchBox& box) {
  const std::vector<SearchBox> boxes = within_data(loop, box);
  std::string where;
  double last = box.frequency_min;
  const auto add = [&](double to) {
    if (to > last) where += (where.empty() ? "" : ", ") + short_number(last) + " to " + short_number(to);
  };
  for (const SearchBox& one : boxes) {
    add(one.frequency_min);
    last = one.frequency_max;
  }
  add(box.frequency_max);
  if (where.empty()) return {};
  return {"the search box holds frequencies at which " + loop.measured.front().path +
          (loop.measured.size() > 1 ? " or another plant" : "") + " was not measured (" + where +
          " rad/s): describing functions predict nothing there"};
}

std::vector<std::string> measured_notes(const Loop& loop) {
  std::vector<std::string> notes;
  for (const MeasuredPart& part : loop.measured) notes.push_back(basis_in_words({part.path, part.response}));
  return notes;
}

}  // namespace limcycle
