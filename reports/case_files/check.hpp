#pragma once
#include <optional>
#include <string>
#include <vector>

#include "limcycle/analysis/frequency/roots/root_search.hpp"
#include "limcycle/reports/provenance.hpp"

namespace limcycle {

/// Facts about a valid case for `limcycle check`.
struct CheckSummary {
  struct Part {
    std::string path, kind;
  };
  /// A block of a diagram; `inputs`: what it reads, or the bodies that it touches.
  struct Block {
    std::string name, kind;
    std::vector<std::string> inputs;
    bool touches = false;
  };
  std::optional<std::string> plant, controller;  ///< kinds; empty for a lone element and for a diagram
  std::vector<Block> blocks;                     ///< of a diagram
  std::vector<Part> elements;                    ///< in the order of evaluation
  std::vector<std::string> states;               ///< linear part, then elements
  int order = 0;                                 ///< of the linear part
  double delay = 0.0;                            ///< s
  std::optional<double> slowest_pole;  ///< largest real part of the poles without the elements, 1/s; empty with delay
  std::optional<bool> stable;          ///< true if the linear part is stable without the elements
  std::optional<SearchBox> search;
  bool search_from_case = false;
  std::vector<std::string> sections;  ///< sections of the case and their commands, in words
};

std::string check_text(const Provenance& provenance, const CheckSummary& summary);

/// {"plant", "controller", "blocks": [{"name", "kind", "inputs"}], "elements": [{"path", "kind"}], "states", "order",
/// "delay", "slowest_pole", "stable",
///  "search": {"amplitude": [from, to], "frequency": [from, to], "from_case"}|null}
std::string check_json(const Provenance& provenance, const CheckSummary& summary);

/// The same in one row: title,plant,controller,elements,states,order,delay,slowest_pole,stable,amplitude_from,
/// amplitude_to,frequency_from,frequency_to; lists separated by spaces.
std::string check_csv(const Provenance& provenance, const CheckSummary& summary);

}  // namespace limcycle
