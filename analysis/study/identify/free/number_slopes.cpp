#include "limcycle/analysis/study/identify/free/number_slopes.hpp"

#include "limcycle/analysis/study/identify/identified_laws.hpp"

namespace limcycle {
namespace {

constexpr std::size_t slots = 8;
using SlopeDual = Dual<slots>;

template <template <class> class Law>
class NumberSlopesOf final : public NumberSlopes {
 public:
  NumberSlopesOf(std::vector<LawNumber> numbers, std::vector<std::size_t> own_rows)
      : numbers_(std::move(numbers)), own_rows_(std::move(own_rows)) {}

  void take(const Element& element) override {
    const auto& law = law_of<Law<double>>(element);
    parts_.clear();
    for (std::size_t first = 0; first < numbers_.size(); first += slots) {
      const auto part = std::span(numbers_).subspan(first, std::min(slots, numbers_.size() - first));
      parts_.push_back(seeded<Law, SlopeDual>(law, part, own_rows_));
    }
  }
  Eigen::Index count() const override { return std::ssize(numbers_); }

  const Eigen::MatrixXd& response(const Input<double>& in, Mode mode, std::span<const double> z) override {
    table_.resize(1 + std::ssize(z), count());
    z_.assign(z.begin(), z.end());
    dz_.resize(z.size());
    for (std::size_t part = 0; part < parts_.size(); ++part) {
      write(0, parts_[part].output(constants(in), mode, z_), part);
      if (z.empty()) continue;
      parts_[part].rate(constants(in), mode, z_, dz_);
      for (std::size_t i = 0; i < z.size(); ++i) write(static_cast<Eigen::Index>(1 + i), dz_[i], part);
    }
    return table_;
  }
  const Eigen::MatrixXd& guard(const Input<double>& in, Mode mode, std::span<const double> z,
                               std::size_t guard) override {
    table_.setZero(1, count());
    if constexpr (HasModes<Law<SlopeDual>, SlopeDual>) {
      z_.assign(z.begin(), z.end());
      for (std::size_t part = 0; part < parts_.size(); ++part) {
        guards_.resize(static_cast<std::size_t>(parts_[part].guards(mode)));
        parts_[part].guard(constants(in), mode, z_, guards_);
        write(0, guards_.at(guard), part);
      }
    }
    return table_;
  }

 private:
  static Input<SlopeDual> constants(const Input<double>& in) {
    return {SlopeDual(in.x), SlopeDual(in.v), SlopeDual(in.drive)};
  }
  void write(Eigen::Index row, const SlopeDual& from, std::size_t part) {
    const std::size_t first = part * slots, end = std::min(numbers_.size(), first + slots);
    for (std::size_t k = first; k < end; ++k) table_(row, static_cast<Eigen::Index>(k)) = from.d[k - first];
  }

  std::vector<LawNumber> numbers_;
  std::vector<std::size_t> own_rows_;
  std::vector<Law<SlopeDual>> parts_;
  std::vector<SlopeDual> z_, dz_, guards_;
  Eigen::MatrixXd table_;
};

}  // namespace

std::unique_ptr<NumberSlopes> number_slopes_of(const Element& law, std::vector<LawNumber> numbers,
                                               std::vector<std::size_t> own_rows) {
  std::unique_ptr<NumberSlopes> result;
  IdentifiedLaws::for_each([&]<template <class> class Law>() {
    if (law.as<Law<double>>() != nullptr)
      result = std::make_unique<NumberSlopesOf<Law>>(std::move(numbers), std::move(own_rows));
  });
  if (!result) throw std::invalid_argument("a law of kind " + std::string(law.kind()) + " cannot be identified");
  return result;
}

}  // namespace limcycle
