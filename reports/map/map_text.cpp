#include <fmt/format.h>

#include <algorithm>
#include <map>

#include "limcycle/reports/format/number.hpp"
#include "limcycle/reports/map/map.hpp"
#include "limcycle/reports/predict/verdict_text.hpp"

namespace limcycle {
namespace {

constexpr int widest_map = 72;  // columns of letters

/// Kinds of behaviour, each with its number of points, the most frequent first.
std::vector<std::pair<std::string, std::size_t>> what_happens(const HuntingMap& map) {
  std::map<std::string, std::size_t> counts;
  for (const auto& point : map.points)
    if (point) ++counts[point->in_words()];
  std::vector<std::pair<std::string, std::size_t>> all(counts.begin(), counts.end());
  std::ranges::stable_sort(all, [](const auto& a, const auto& b) { return a.second > b.second; });
  return all;
}

std::size_t count(const HuntingMap& map, std::size_t method, Worth worth) {
  return static_cast<std::size_t>(std::ranges::count_if(map.points, [&](const auto& point) {
    return point && method < point->methods.size() && point->methods[method].worth == worth;
  }));
}

std::string share(std::size_t some, std::size_t all) {
  return as_percent(all == 0 ? 0.0 : static_cast<double>(some) / static_cast<double>(all));
}

std::string side(const MapAxis& axis, const std::string& unit) {
  return fmt::format("{} from {} to {}{}, {} points", axis.path, with_digits(axis.from, 6),
                     Units::attach(with_digits(axis.to, 6), unit == "1" ? "" : unit),
                     axis.logarithmic ? " (logarithmic)" : "", axis.points);
}

/// The map with y upwards; wide ones are thinned to every n-th column and row.
std::string letters(const HuntingMap& map) {
  const int step = (map.x.points + widest_map - 1) / widest_map;
  std::string out;
  for (int row = (map.y.points - 1) / step * step; row >= 0; row -= step) {
    out += "  ";
    for (int column = 0; column < map.x.points; column += step) out += map_letter(map.at(column, row));
    out.erase(out.find_last_not_of(' ') + 1);
    out += "\n";
  }
  return out;
}

}  // namespace

char map_letter(const std::optional<MapPoint>& point) {
  if (!point) return ' ';
  if (point->outcomes.empty()) return '/';
  const bool rest = point->has(Outcome::rest), hunts = point->has(Outcome::cycle);
  if (point->has(Outcome::divergence)) return 'x';
  if (hunts) return rest ? '+' : point->has(Outcome::sliding) ? '*' : 'H';
  if (point->has(Outcome::irregular)) return '~';
  if (point->has(Outcome::family)) return 'o';
  if (rest) return '.';
  return point->has(Outcome::sliding) ? 's' : '?';
}

std::string map_answer(const MapReport& report) {
  const auto all = what_happens(report.map);
  const std::size_t known = report.map.known();
  if (known == 0) return "Nothing was computed.";
  const auto hunting = static_cast<std::size_t>(
      std::ranges::count_if(report.map.points, [](const auto& point) { return point && point->has(Outcome::cycle); }));
  const auto uneven = static_cast<std::size_t>(std::ranges::count_if(
      report.map.points, [](const auto& point) { return point && point->has(Outcome::irregular); }));
  std::string answer =
      hunting == 0       ? uneven > 0 ? "No limit cycle was found on this map." : "The loop hunts nowhere on this map."
      : hunting == known ? "The loop can hunt everywhere on this map."
                         : "The loop can hunt on " + share(hunting, known) + " of this map.";
  if (uneven > 0) answer += " It moves for ever without a period on " + share(uneven, known) + " of it.";
  if (report.map.methods.empty())
    answer += " No method was judged, and a cycle that none of the starts reaches may be missing.";
  for (std::size_t m = 0; m < report.map.methods.size(); ++m) {
    const std::size_t missed = count(report.map, m, Worth::missed), wrong = count(report.map, m, Worth::wrong),
                      biased = count(report.map, m, Worth::biased);
    std::string method = method_in_words(report.map.methods[m]);
    if (method.starts_with("the ")) method[0] = 'T';
    answer += " " + method;
    if (missed + wrong + biased == 0) {
      answer += " is never wrong.";
      continue;
    }
    std::string faults;
    const auto add = [&](std::size_t number, const std::string& words) {
      if (number > 0) faults += (faults.empty() ? "" : ", ") + words + " on " + share(number, known);
    };
    add(missed, uneven > 0 ? "finds nothing where the loop hunts or moves without a period"
                           : "finds no cycle where one exists");
    add(wrong, "predicts one that does not exist");
    add(biased, "is off by more than 5 %");
    answer += " " + faults + ".";
  }
  return answer;
}

Table happens_table(const MapReport& report) {
  Table table{{{"outcome", "", Align::left}, {"points", ""}, {"share", ""}, {"letter", "", Align::left}}, {}};
  for (const auto& entry : what_happens(report.map)) {
    const auto sample = std::ranges::find_if(
        report.map.points, [&](const auto& point) { return point && point->in_words() == entry.first; });
    table.rows.push_back({entry.first, std::to_string(entry.second), share(entry.second, report.map.known()),
                          std::string(1, map_letter(*sample))});
  }
  return table;
}

Table worth_table(const MapReport& report) {
  constexpr Worth kinds[] = {Worth::right, Worth::biased,    Worth::missed,
                             Worth::wrong, Worth::undecided, Worth::not_applicable};
  Table table{{{"method", "", Align::left}}, {}};
  for (const Worth kind : kinds) table.columns.push_back({std::string(to_string(kind)), ""});
  for (std::size_t m = 0; m < report.map.methods.size(); ++m) {
    table.rows.push_back({report.map.methods[m]});
    for (const Worth kind : kinds) table.rows.back().push_back(share(count(report.map, m, kind), report.map.known()));
  }
  return table;
}

Document map_document(const std::string& title, const MapReport& report) {
  const HuntingMap& map = report.map;
  Document out(wrapped(title) + "\n" + wrapped(map_answer(report)) + "\n");
  if (map.known() < map.size())
    out += wrapped(fmt::format("{} of {} points are computed.", map.known(), map.size())) + "\n";
  out += wrapped("x: " + side(map.x, report.x_unit)) + wrapped("y: " + side(map.y, report.y_unit)) + "\n";
  if (map.known() == 0) return out;
  out += letters(map) + "\n";
  out.add_untitled("What happens", happens_table(report));
  if (!map.methods.empty()) out.add("Reliability of each method", worth_table(report));
  return out;
}

std::string map_text(const std::string& title, const MapReport& report) { return map_document(title, report).text(); }

}  // namespace limcycle
