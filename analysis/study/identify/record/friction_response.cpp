#include "limcycle/analysis/study/identify/record/friction_response.hpp"

#include <cmath>
#include <stdexcept>

#include "limcycle/analysis/study/identify/identified_laws.hpp"
#include "limcycle/analysis/study/identify/record/record_march.hpp"

namespace limcycle {
namespace {

/// Force of a law that sticks at rest, in sliding; at rest 0, as such rows are not compared.
template <class S, template <class> class Law>
S sliding_force(const Law<S>& law, double v) {
  if (v == 0.0) return S(0.0);
  const Input<S> in{S(0.0), S(v), S(v < 0.0 ? -infinite : infinite)};
  return law.output(in, Mode{v < 0.0 ? -1 : 1}, {});
}

template <template <class> class Law>
class ResponseOf final : public FrictionResponse {
 public:
  ResponseOf(std::vector<LawNumber> numbers, std::vector<std::size_t> own_rows)
      : numbers_(std::move(numbers)), own_rows_(std::move(own_rows)) {}

  bool run(const Element& element, const PreparedRecord& record, std::vector<double>& forces, Eigen::MatrixXd* slopes,
           double fineness) const override {
    const auto& law = law_of<Law<double>>(element);
    const auto rows = static_cast<Eigen::Index>(record.compared.size());
    forces.assign(record.compared.size(), 0.0);
    const auto probe = recast<Law, Dual<1>>(law);
    if (slopes == nullptr) {
      const auto set = [&](std::size_t i, double force) { forces[i] = force; };
      return march(law, probe, seeded<Law, MarchDual>(law, {}, own_rows_), record, fineness, set) && finite(forces);
    }
    slopes->setZero(rows, std::ssize(numbers_));
    for (std::size_t first = 0; first < numbers_.size() || first == 0; first += time_slot) {
      const auto part = std::span(numbers_).subspan(first, std::min(time_slot, numbers_.size() - first));
      const auto dual = seeded<Law, MarchDual>(law, part, own_rows_);
      const auto set = [&](std::size_t i, const MarchDual& force) {
        forces[i] = force.value;
        for (std::size_t k = 0; k < part.size(); ++k)
          (*slopes)(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(first + k)) = force.d[k];
      };
      if (!march(dual, probe, dual, record, fineness, set)) return false;
    }
    return finite(forces) && slopes->allFinite();
  }

 private:
  static bool finite(const std::vector<double>& values) {
    return std::ranges::all_of(values, [](double one) { return std::isfinite(one); });
  }

  template <class S>
  static bool march(const Law<S>& law, const Law<Dual<1>>& probe, const Law<MarchDual>& sliding,
                    const PreparedRecord& record, double fineness, const auto& set) {
    if constexpr (CanHold<Law<S>>) {
      for (std::size_t i = 0; i < record.compared.size(); ++i) set(i, sliding_force<S, Law>(law, record.compared[i].v));
      return true;
    } else {
      RecordMarch<S, Law> body(law, probe, sliding, fineness);
      if (record.kind == RecordKind::steady_velocity) {
        for (std::size_t i = 0; i < record.compared.size(); ++i) {
          body.begin_sliding(record.compared[i].v);
          set(i, body.force(record.compared[i].v));
        }
        return true;
      }
      if (record.kind == RecordKind::lag)
        body.begin_sliding(record.v_start);
      else
        body.begin_relaxed(record.v_start);
      if (record.first_sample >= 0) set(static_cast<std::size_t>(record.first_sample), body.force(record.v_start));
      for (const auto& piece : record.pieces) {
        if (!body.cross(piece)) return false;
        if (piece.sample < 0) continue;
        const auto i = static_cast<std::size_t>(piece.sample);
        set(i, body.force(record.compared[i].v));
      }
      return true;
    }
  }

  std::vector<LawNumber> numbers_;
  std::vector<std::size_t> own_rows_;
};

}  // namespace

const std::vector<std::string>& identified_kinds() {
  static const std::vector<std::string> kinds = [] {
    std::vector<std::string> list;
    IdentifiedLaws::for_each([&]<template <class> class Law>() { list.emplace_back(Law<double>::kind); });
    return list;
  }();
  return kinds;
}

std::unique_ptr<FrictionResponse> response_of(const Element& law, std::vector<LawNumber> numbers,
                                              std::vector<std::size_t> own_rows) {
  std::unique_ptr<FrictionResponse> result;
  IdentifiedLaws::for_each([&]<template <class> class Law>() {
    if (law.as<Law<double>>() != nullptr)
      result = std::make_unique<ResponseOf<Law>>(std::move(numbers), std::move(own_rows));
  });
  if (!result) throw std::invalid_argument("a law of kind " + std::string(law.kind()) + " cannot be identified");
  return result;
}

}  // namespace limcycle
