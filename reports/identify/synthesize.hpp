#pragma once
#include <string>
#include <vector>

#include "limcycle/analysis/study/identify/record/synthesize.hpp"
#include "limcycle/reports/provenance.hpp"

namespace limcycle {

/// Files that were written for a rig with a known law.
struct SynthesizeReport {
  struct Record {
    RecordKind kind;
    std::string file;
    std::size_t rows;
  };
  Element law;
  RigFaults faults;
  std::vector<Record> records;
  std::string case_file;
};

std::string synthesize_text(const std::string& title, const SynthesizeReport& report);
std::string synthesize_json(const Provenance& provenance, const SynthesizeReport& report);
std::string synthesize_csv(const SynthesizeReport& report);

}  // namespace limcycle
