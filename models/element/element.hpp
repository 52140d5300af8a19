#pragma once
#include <algorithm>
#include <memory>
#include <string>
#include <typeinfo>
#include <vector>

#include "limcycle/models/dual.hpp"
#include "limcycle/models/element/concepts.hpp"
#include "limcycle/models/friction/features.hpp"

namespace limcycle {

/// Equations of an element on the scalar S, behind virtual calls: see LawOn and HasModes. Spans are at least as long as
/// the number of states or guards.
template <class S>
struct Equations {
  virtual ~Equations() = default;
  virtual S output(const Input<S>& in, Mode mode, std::span<const S> z) const = 0;
  virtual void rate(const Input<S>& in, Mode mode, std::span<const S> z, std::span<S> dz) const = 0;
  /// Output and rates in one call, so that shared terms are computed once; `dz` may be empty.
  virtual S respond(const Input<S>& in, Mode mode, std::span<const S> z, std::span<S> dz) const = 0;
  virtual void guard(const Input<S>& in, Mode mode, std::span<const S> z, std::span<S> g) const = 0;
  virtual Mode next(const Input<S>& in, Mode mode, std::span<S> z, int fired) const = 0;
  /// J; 0 where the element states no energy or has no state.
  virtual S storage(Mode mode, std::span<const S> z) const = 0;
};

/// Properties of a class of elements, for any parameters.
struct ElementFacts {
  std::string_view kind;               ///< as in a case file; for a user's own law the name that it gives itself
  std::string_view equation, source;   ///< in words and formulas
  const Features* features = nullptr;  ///< of a friction law of this library
  bool friction = false;               ///< a friction law, of this library or of the user
  bool by_differences = false;         ///< written on double only: its derivatives are differences
  bool has_modes = false;              ///< see HasModes; without, guards() is 0
  Held holds = Held::nothing;          ///< see CanHold
  bool needs_drive = false;            ///< see NeedsDrive
  bool needs_rate = false;             ///< see NeedsRate
  bool uses_rate = false;              ///< the output or a guard depends on the rate of the input
  bool acts_on_rate = false;           ///< it responds to the rate of its input
  bool piecewise_affine = false;       ///< see PiecewiseAffine
  bool rate_independent = false;       ///< see RateIndependent
  bool has_selection = false;          ///< see HasSelection
  bool has_closed_form = false;        ///< see HasExactDescribingFunction
  bool has_clock = false;              ///< see HasClock
  bool keeps_return_points = false;    ///< so that the number of its states in use changes along a motion
  bool is_one_state = false;           ///< F and dz/dt are functions of one state and the velocity alone
  std::optional<Mode> stuck = {};      ///< the mode of a body at rest
};

/// An element behind virtual calls. Members that a class does not offer get neutral defaults: see element_face.hpp.
struct ElementFace : Equations<double> {
  virtual const ElementFacts& facts() const = 0;
  virtual int states() const = 0;
  virtual int guards(Mode mode) const = 0;
  virtual Mode start(const Input<double>& in, std::span<double> z) const = 0;
  virtual bool knows_sliding() const = 0;
  virtual Mode after_sliding(const Input<double>& in, std::span<double> z) const = 0;
  virtual bool odd() const = 0;
  virtual Mode mirror(Mode mode) const = 0;
  virtual Scales scales() const = 0;
  virtual double state_scale(int i) const = 0;
  virtual bool even_state(int i) const = 0;
  virtual bool unused(Mode mode, int i) const = 0;
  virtual Held held(Mode mode) const = 0;
  virtual double selection(Mode mode, double output) const = 0;
  virtual bool drive_is_of_rate() const = 0;
  virtual double drive_band() const = 0;
  virtual bool arrests(Mode mode, int fired) const = 0;
  virtual double due(Mode mode, std::span<const double> z) const = 0;
  virtual bool has_storage() const = 0;
  virtual bool is_passive() const = 0;
  virtual bool follows_position() const = 0;
  virtual std::optional<std::complex<double>> exact_describing_function(double A, double w, double bias) const = 0;
  virtual std::optional<double> exact_mean(double A, double bias) const = 0;
  virtual std::optional<std::pair<double, double>> slope_bounds() const = 0;
  virtual std::pair<double, double> working_gain() const = 0;
  virtual double switching_input() const = 0;
  virtual double steep_exponent() const = 0;
  virtual std::optional<std::pair<double, double>> pull(double mean, double swing) const = 0;
  virtual std::vector<std::pair<double, double>> state_bounds() const = 0;
  virtual std::optional<double> force_bound(double speed) const = 0;
  virtual std::vector<double> knots() const = 0;

  virtual const std::vector<ParameterRow>& parameters() const = 0;
  virtual std::vector<ParameterValue> values() const = 0;
  virtual std::vector<ParameterValue> defaults() const = 0;
  virtual std::shared_ptr<ElementFace> with(const std::vector<ParameterValue>& values) const = 0;
  virtual std::optional<BrokenRule> validate() const = 0;

  virtual std::shared_ptr<ElementFace> copy() const = 0;
  virtual const std::type_info& type() const = 0;
  virtual void* law() = 0;
  virtual std::shared_ptr<const Equations<Dual<1>>> on_dual_1() const = 0;
  virtual std::shared_ptr<const Equations<Dual<4>>> on_dual_4() const = 0;
};

/// The face of a class. For classes of this library it is compiled in their own sources; element_face.hpp makes others.
template <class Law>
std::shared_ptr<ElementFace> face_of(const Law& law);

/// Any friction law or element: it holds parameters only, so that one object serves many threads and methods. On double
/// it is `Element`; on<Dual<N>>() returns the same element on dual numbers. Copies share their contents until one of
/// them is changed. Cost of a call: a virtual call plus the law's own work.
template <class S>
class ElementOn {
 public:
  explicit ElementOn(std::shared_ptr<ElementFace> face) : face_(std::move(face)) {
    if constexpr (std::same_as<S, Dual<1>>) own_ = face_->on_dual_1();
    if constexpr (std::same_as<S, Dual<4>>) own_ = face_->on_dual_4();
  }
  template <class Law>
  requires(LawOn<Law, double>&& std::same_as<S, double> && !std::same_as<Law, ElementOn>)
      ElementOn(const Law& law)  // NOLINT(google-explicit-constructor): any law is an element
      : ElementOn(face_of(law)) {}

  /// The same element on another scalar: double, Dual<1> or Dual<4>.
  template <class To>
  ElementOn<To> on() const {
    return ElementOn<To>(face_);
  }

  const ElementFacts& facts() const { return face_->facts(); }
  std::string_view kind() const { return facts().kind; }
  bool is_friction() const { return facts().friction; }
  bool has_modes() const { return facts().has_modes; }
  bool needs_drive() const { return facts().needs_drive; }

  int states() const { return face_->states(); }
  void rate(const Input<S>& in, Mode mode, std::span<const S> z, std::span<S> dz) const {
    equations().rate(in, mode, z, dz);
  }
  S output(const Input<S>& in, Mode mode, std::span<const S> z) const { return equations().output(in, mode, z); }
  /// Output, and rates in `dz` unless that is empty.
  S respond(const Input<S>& in, Mode mode, std::span<const S> z, std::span<S> dz) const {
    return equations().respond(in, mode, z, dz);
  }
  int guards(Mode mode) const { return face_->guards(mode); }
  void guard(const Input<S>& in, Mode mode, std::span<const S> z, std::span<S> g) const {
    equations().guard(in, mode, z, g);
  }
  Mode next(const Input<S>& in, Mode mode, std::span<S> z, int fired) const {
    return equations().next(in, mode, z, fired);
  }
  Mode start(const Input<double>& in, std::span<double> z) const { return face_->start(in, z); }
  /// True if the element offers its mode and state after long sliding at in.v; without it, those of no history.
  bool knows_sliding() const { return face_->knows_sliding(); }
  Mode after_sliding(const Input<double>& in, std::span<double> z) const { return face_->after_sliding(in, z); }
  bool odd() const { return face_->odd(); }
  Mode mirror(Mode mode) const { return face_->mirror(mode); }
  Scales scales() const { return face_->scales(); }
  double state_scale(int i) const { return face_->state_scale(i); }
  /// True if reflecting the motion leaves state i unchanged (a lagged level, a time) instead of changing its sign.
  bool even_state(int i) const { return face_->even_state(i); }
  /// True if state i stands in this mode and nothing depends on it; see is_unused.
  bool unused(Mode mode, int i) const { return face_->unused(mode, i); }
  /// Signal that the element keeps at zero in this mode.
  Held held(Mode mode) const { return face_->held(mode); }
  /// True if it has a mode in which it holds its body at rest, as set-valued friction has.
  bool may_stick() const { return facts().holds == Held::rate; }
  /// Element of Sgn(v) that this output of a set-valued law at rest stands for.
  double selection(Mode mode, double output) const { return face_->selection(mode, output); }
  bool drive_is_of_rate() const { return face_->drive_is_of_rate(); }
  double drive_band() const { return face_->drive_band(); }
  bool arrests(Mode mode, int fired) const { return face_->arrests(mode, fired); }
  /// Time until the next switch by the element's own clock, s; infinite without one.
  double due(Mode mode, std::span<const double> z) const { return face_->due(mode, z); }
  /// Stored energy (J), if the element offers it; 0 if it does not or has no state.
  bool has_storage() const { return face_->has_storage(); }
  S storage(Mode mode, std::span<const S> z) const { return equations().storage(mode, z); }
  /// True if the equations prove, for these parameters, that no motion takes more energy out of a friction law than was
  /// put in (passive from v to F, see Features::passivity); false: not, or not known.
  bool is_passive() const { return face_->is_passive(); }
  /// True if the output depends on the input itself, not only on its rate and the state.
  bool follows_position() const { return face_->follows_position(); }

  /// Closed forms, if available: see HasExactDescribingFunction, HasExactMean, SlopeBounded.
  std::optional<std::complex<double>> exact_describing_function(double A, double w, double bias) const {
    return face_->exact_describing_function(A, w, bias);
  }
  std::optional<double> exact_mean(double A, double bias) const { return face_->exact_mean(A, bias); }
  std::optional<std::pair<double, double>> slope_bounds() const { return face_->slope_bounds(); }
  /// Gain on the input and on its rate in the normal working range: inside a saturation, outside a dead zone; 0 for
  /// elements without such a gain (friction, relay).
  std::pair<double, double> working_gain() const { return face_->working_gain(); }
  /// Input at which an element without scales changes its behaviour; 0 if there is none.
  double switching_input() const { return face_->switching_input(); }
  /// Power of |v| with which a set-valued law leaves its level at rest, if less than 1: its slope is infinite there. 1
  /// for all others.
  double steep_exponent() const { return face_->steep_exponent(); }
  /// For an element with a restoring output, such as gravity, and a sinusoid of amplitude `swing` about `mean`: mean
  /// output, and its derivative with respect to the mean.
  std::optional<std::pair<double, double>> pull(double mean, double swing) const { return face_->pull(mean, swing); }
  /// Least and largest value of each state, and largest |F| at speeds up to `speed` (m/s), if the equations prove them.
  std::vector<std::pair<double, double>> state_bounds() const { return face_->state_bounds(); }
  std::optional<double> force_bound(double speed) const { return face_->force_bound(speed); }
  /// Speeds at which a piecewise curve may have a corner.
  std::vector<double> knots() const { return face_->knots(); }

  /// The table of parameters, empty for a user's own law, and their values in its order.
  const std::vector<ParameterRow>& parameters() const { return face_->parameters(); }
  std::vector<ParameterValue> values() const { return face_->values(); }
  std::vector<ParameterValue> defaults() const { return face_->defaults(); }
  /// Value of a scalar parameter; empty if no scalar parameter has that key.
  std::optional<double> number(std::string_view key) const { return number_of(parameters(), values(), key); }
  /// The same kind with other values, unchecked: see validate(). Throws std::invalid_argument for one of another type.
  ElementOn with(const std::vector<ParameterValue>& values) const { return ElementOn(face_->with(values)); }
  /// The same with one number replaced. Throws std::invalid_argument if no parameter has that key.
  ElementOn with(std::string_view key, double value) const;
  std::optional<BrokenRule> validate() const { return face_->validate(); }

  /// The law itself if it is of that class, else null. A change through the pointer affects this element only; an
  /// element on dual numbers that was made before stays unchanged.
  template <class Law>
  const Law* as() const {
    return face_->type() == typeid(Law) ? static_cast<const Law*>(face_->law()) : nullptr;
  }
  template <class Law>
  Law* as() {
    if (face_->type() != typeid(Law)) return nullptr;
    if (face_.use_count() > 1) face_ = face_->copy();
    return static_cast<Law*>(face_->law());
  }
  bool is_of_kind_of(const ElementOn& other) const { return face_->type() == other.face_->type(); }

 private:
  const Equations<S>& equations() const {
    if constexpr (std::same_as<S, double>)
      return *face_;
    else
      return *own_;
  }

  std::shared_ptr<ElementFace> face_;
  std::shared_ptr<const Equations<S>> own_;  ///< on double: null, since the face holds them
};

using Element = ElementOn<double>;

template <class S>
ElementOn<S> ElementOn<S>::with(std::string_view key, double value) const {
  const auto& rows = parameters();
  const auto row = std::ranges::find(rows, key, &ParameterRow::key);
  if (row == rows.end())
    throw std::invalid_argument(std::string(kind()) + " has no parameter called " + std::string(key));
  auto changed = values();
  changed[static_cast<std::size_t>(row - rows.begin())] = value;
  return with(changed);
}

/// The law of an element whose class is known. Throws std::invalid_argument if it is of another class.
template <class Law>
const Law& law_of(const Element& element) {
  if (const Law* law = element.as<Law>()) return *law;
  throw std::invalid_argument("the element is no " + std::string(Law::kind) + " but a " + std::string(element.kind()));
}
template <class Law>
Law& law_of(Element& element) {
  if (Law* law = element.as<Law>()) return *law;
  throw std::invalid_argument("the element is no " + std::string(Law::kind) + " but a " + std::string(element.kind()));
}

}  // namespace limcycle
