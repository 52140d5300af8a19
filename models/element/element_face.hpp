#pragma once
#include <stdexcept>
#include <utility>

#include "limcycle/models/element/element.hpp"
#include "limcycle/models/element/of_controllers/differenced.hpp"

/// Puts a class behind the face of an element. Included by the source of each law, which compiles that law once, and by
/// own_law.hpp, for the laws of users.
namespace limcycle {

/// The class template of a class on double, if it can be instantiated on another scalar.
template <class Law>
struct KindOf {
  static constexpr bool templated = false;
};
template <template <class> class Kind>
requires(OffersScalar<Kind<double>, Dual<1>> || requires { Kind<Dual<1>>::parameters(); }) struct KindOf<Kind<double>> {
  static constexpr bool templated = true;
  template <class S>
  using On = Kind<S>;
  template <class S>
  static Kind<S> on(const Kind<double>& law) {
    return recast<Kind, S>(law);
  }
};

/// The members of a class that depend on the scalar; `Base` is the interface that they implement.
template <class Law, class S, class Base>
class EquationsOf : public Base {
 public:
  explicit EquationsOf(Law law) : law_(std::move(law)) {}

  S output(const Input<S>& in, Mode mode, std::span<const S> z) const final { return law_.output(in, mode, z); }
  void rate(const Input<S>& in, Mode mode, std::span<const S> z, std::span<S> dz) const final {
    if constexpr (has_rate) law_.rate(in, mode, z, dz);
  }
  S respond(const Input<S>& in, Mode mode, std::span<const S> z, std::span<S> dz) const final {
    const S w = law_.output(in, mode, z);
    if constexpr (has_rate)
      if (!dz.empty()) law_.rate(in, mode, z, dz);
    return w;
  }
  void guard(const Input<S>& in, Mode mode, std::span<const S> z, std::span<S> g) const final {
    if constexpr (HasModes<Law, S>) law_.guard(in, mode, z, g);
  }
  Mode next(const Input<S>& in, Mode mode, std::span<S> z, int fired) const final {
    if constexpr (HasModes<Law, S>) return law_.next(in, mode, z, fired);
    return mode;
  }
  S storage(Mode mode, std::span<const S> z) const final {
    if constexpr (HasStorage<Law, S>) return law_.storage(mode, z);
    return S(0.0);
  }

 protected:
  static constexpr bool has_rate =
      requires(const Law law, const Input<S> in, Mode mode, std::span<const S> z, std::span<S> dz) {
    law.rate(in, mode, z, dz);
  };
  Law law_;
};

/// Author of a law.
enum class Author { library, user };

template <class Law>
constexpr ElementFacts facts_of(Author author) {
  const bool own = author == Author::user;
  ElementFacts facts;
  facts.kind = "own-law";
  facts.equation = "that of a type of the user's own";
  facts.source = "the program that made it";
  if constexpr (requires { std::string_view(Law::kind); }) facts.kind = Law::kind;
  if constexpr (requires { std::string_view(Law::equation); }) facts.equation = Law::equation;
  if constexpr (requires { std::string_view(Law::source); }) facts.source = Law::source;
  if constexpr (requires { Law::features.memory; }) facts.features = &Law::features;
  facts.friction = own || facts.features != nullptr;
  facts.by_differences = !KindOf<Law>::templated;
  facts.has_modes = HasModes<Law, double>;
  if constexpr (CanHold<Law>) facts.holds = Law::holds;
  facts.needs_drive = NeedsDrive<Law>;
  facts.needs_rate = NeedsRate<Law> || (own && !requires { Law::output_needs_rate; });  // assumed if not stated
  facts.uses_rate = facts.needs_rate || requires { requires Law::uses_rate; };
  facts.acts_on_rate = requires { requires Law::acts_on_rate; };
  facts.piecewise_affine = PiecewiseAffine<Law>;
  facts.rate_independent = RateIndependent<Law>;
  facts.has_selection = HasSelection<Law, double>;
  facts.has_closed_form = HasExactDescribingFunction<Law>;
  facts.has_clock = HasClock<Law>;
  facts.keeps_return_points = requires { requires Law::keeps_return_points; };
  facts.is_one_state = requires { requires Law::is_one_state; };
  if constexpr (requires { Law::stuck; }) facts.stuck = Law::stuck;
  return facts;
}

/// True if a law without `follows_position()` depends on its position, found by evaluation; see own_law().
bool tried_for_position(const ElementFace& law);

template <class Law>
class FaceOf final : public EquationsOf<Law, double, ElementFace> {
  using Base = EquationsOf<Law, double, ElementFace>;
  using Base::law_;
  using Room = std::span<double>;

 public:
  FaceOf(Law law, Author author) : Base(std::move(law)), author_(author) {
    if (author == Author::user) follows_position_ = tried_for_position(*this);
  }

  const ElementFacts& facts() const override {
    static const ElementFacts of_library = facts_of<Law>(Author::library), of_own = facts_of<Law>(Author::user);
    return author_ == Author::user ? of_own : of_library;
  }
  int states() const override {
    if constexpr (requires { law_.states(); }) return law_.states();
    return 0;
  }
  int guards(Mode mode) const override {
    if constexpr (HasModes<Law, double>) return law_.guards(mode);
    return 0;
  }
  Mode start(const Input<double>& in, Room z) const override {
    if constexpr (HasModes<Law, double>) return law_.start(in, z);
    return {};
  }
  bool knows_sliding() const override { return KnowsSliding<Law>; }
  Mode after_sliding(const Input<double>& in, Room z) const override {
    if constexpr (KnowsSliding<Law>) return law_.after_sliding(in, z);
    return FaceOf::start(in, z);
  }
  bool odd() const override {
    if constexpr (requires { law_.odd(); }) return law_.odd();
    return false;
  }
  Mode mirror(Mode mode) const override {
    if constexpr (requires { law_.mirror(mode); }) return law_.mirror(mode);
    return mode;
  }
  Scales scales() const override { return law_.scales(); }
  double state_scale(int i) const override {
    if constexpr (requires { law_.state_scale(i); }) return law_.state_scale(i);
    return law_.scales().displacement;
  }
  bool even_state(int i) const override { return is_even_state(law_, i); }
  bool unused(Mode mode, int i) const override { return is_unused(law_, mode, i); }
  Held held(Mode mode) const override {
    if constexpr (CanHold<Law>) return law_.held(mode);
    return Held::nothing;
  }
  double selection(Mode mode, double output) const override {
    if constexpr (HasSelection<Law, double>) return law_.selection(mode, output);
    return 0.0;
  }
  bool drive_is_of_rate() const override { return limcycle::drive_is_of_rate(law_); }
  double drive_band() const override { return limcycle::drive_band(law_); }
  double due(Mode mode, std::span<const double> z) const override {
    if constexpr (HasClock<Law>) return law_.due(mode, z);
    return infinite;
  }
  bool arrests(Mode mode, int fired) const override { return limcycle::arrests(law_, mode, fired); }
  bool has_storage() const override {
    if constexpr (requires { law_.has_storage(); }) return law_.has_storage();
    return HasStorage<Law, double>;
  }
  bool is_passive() const override {
    if constexpr (requires { law_.is_passive(); }) return law_.is_passive();
    return false;
  }
  bool follows_position() const override {
    if constexpr (requires { law_.follows_position(); }) return law_.follows_position();
    return follows_position_;
  }
  std::optional<std::complex<double>> exact_describing_function(double A, double w, double bias) const override {
    if constexpr (HasExactDescribingFunction<Law>) return law_.exact_describing_function(A, w, bias);
    return std::nullopt;
  }
  std::optional<double> exact_mean(double A, double bias) const override {
    if constexpr (HasExactMean<Law>) return law_.exact_mean(A, bias);
    return std::nullopt;
  }
  std::optional<std::pair<double, double>> slope_bounds() const override {
    if constexpr (SlopeBounded<Law>) return law_.slope_bounds();
    return std::nullopt;
  }
  std::pair<double, double> working_gain() const override {
    if constexpr (requires { law_.working_gain(); }) return law_.working_gain();
    if constexpr (SlopeBounded<Law>) return {law_.slope_bounds().second, 0.0};
    return {0.0, 0.0};
  }
  double switching_input() const override {
    if constexpr (requires { law_.switching_input(); }) return law_.switching_input();
    return 0.0;
  }
  double steep_exponent() const override {
    if constexpr (CanHold<Law> && requires { law_.steep_exponent(); }) return law_.steep_exponent();
    return 1.0;
  }
  std::optional<std::pair<double, double>> pull(double mean, double swing) const override {
    if constexpr (PullsBack<Law>) return std::pair(law_.mean_output(mean, swing), law_.mean_slope(mean, swing));
    return std::nullopt;
  }
  std::vector<std::pair<double, double>> state_bounds() const override {
    if constexpr (requires { law_.state_bounds(); }) return law_.state_bounds();
    return {};
  }
  std::optional<double> force_bound(double speed) const override {
    if constexpr (requires { law_.force_bound(speed); }) return law_.force_bound(speed);
    return std::nullopt;
  }
  std::vector<double> knots() const override {
    if constexpr (requires { law_.knots(); }) return law_.knots();
    return {};
  }

  const std::vector<ParameterRow>& parameters() const override {
    if constexpr (has_table) return rows_of<Law>();
    static const std::vector<ParameterRow> none;
    return none;
  }
  std::vector<ParameterValue> values() const override {
    if constexpr (has_table) return values_of(law_);
    return {};
  }
  std::vector<ParameterValue> defaults() const override {
    if constexpr (has_table) return values_of(Law{});
    return {};
  }
  std::shared_ptr<ElementFace> with(const std::vector<ParameterValue>& values) const override {
    auto changed = std::make_shared<FaceOf>(*this);
    if constexpr (has_table) set_values(changed->law_, values);
    return changed;
  }
  std::optional<BrokenRule> validate() const override {
    if constexpr (requires { law_.validate(); }) return law_.validate();
    return std::nullopt;
  }

  std::shared_ptr<ElementFace> copy() const override { return std::make_shared<FaceOf>(*this); }
  const std::type_info& type() const override { return typeid(Law); }
  void* law() override { return &law_; }
  std::shared_ptr<const Equations<Dual<1>>> on_dual_1() const override { return on<Dual<1>>(); }
  std::shared_ptr<const Equations<Dual<4>>> on_dual_4() const override { return on<Dual<4>>(); }

 private:
  static constexpr bool has_table = requires { Law::parameters(); }
  &&std::is_default_constructible_v<Law>;

  template <class S>
  std::shared_ptr<const Equations<S>> on() const {
    if constexpr (KindOf<Law>::templated)
      return std::make_shared<EquationsOf<typename KindOf<Law>::template On<S>, S, Equations<S>>>(
          KindOf<Law>::template on<S>(law_));
    else
      return std::make_shared<Differenced<S>>(copy());
  }

  Author author_;
  bool follows_position_ = false;
};

template <class Law>
std::shared_ptr<ElementFace> face_of(const Law& law) {
  return std::make_shared<FaceOf<Law>>(law, Author::library);
}

}  // namespace limcycle
