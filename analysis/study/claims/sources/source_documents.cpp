#include "limcycle/analysis/study/claims/sources/source_documents.hpp"

#include <algorithm>
#include <iterator>
#include <stdexcept>

#include "limcycle/analysis/short_number.hpp"

namespace limcycle {

std::vector<Claim> source_document_claims() {
  std::vector<Claim> list;
  for (const auto subject : {document_property_claims, document_presliding_claims, document_memory_claims,
                             document_breakaway_claims, document_pendulum_claims}) {
    auto some = subject();
    list.insert(list.end(), std::make_move_iterator(some.begin()), std::make_move_iterator(some.end()));
  }
  return list;
}

LawSetting document_law(const std::string& label) {
  const auto& all = law_settings();
  const auto found = std::ranges::find(all, label, &LawSetting::label);
  if (found == all.end()) throw std::invalid_argument("there is no setting '" + label + "'");
  return *found;
}

LawSetting random_proposed_law(RandomShares& random) {
  const double Fc = random.log_between(0.4, 3.0), Fs = Fc * random.between(1.0, 2.0);
  LawSetting law = document_law("non-drift").with("Fs", Fs).with("Fc", Fc);
  for (const char* key : {"vs", "Zb", "sigma", "tau"}) law = law.scaled(key, random.log_between(1.0 / 3.0, 3.0));
  law.break_away = law.number("Zb");
  return law;
}

std::string values_of(const LawSetting& setting) {
  std::string out;
  for (const auto& [key, value] : setting.values)
    if (const auto* number = std::get_if<double>(&value))
      out += (out.empty() ? "" : ", ") + key + " = " + short_number(*number);
  return out;
}

Signal piecewise_constant(const std::vector<double>& times, const std::vector<double>& values) {
  std::vector<double> t, u;
  for (std::size_t i = 0; i < values.size(); ++i) {
    t.insert(t.end(), {times[i], times[i + 1]});
    u.insert(u.end(), {values[i], values[i]});
  }
  return signal_through(std::move(t), std::move(u));
}

bool completed(const ForcedRun& run, ClaimChecks& checks) {
  if (run.status != Status::converged) checks.stop(run.status);
  return run.status == Status::converged;
}

}  // namespace limcycle
