#pragma once
#include <memory>

#include "limcycle/models/element/element.hpp"

namespace limcycle {

/// Equations, on dual numbers, of a law that is written on double only. Its derivatives are central differences with
/// respect to each variable q that varies,
///   df/dq = (f(q + h) - f(q - h))/2h + O(h^2),   h = eps^(1/3) max(|q|, L),  eps = 2.2e-16,
/// with L the size that the law states for q: its `scales()` for x, v and (that of the output) the drive, its
/// `state_scale(i)` for a state. For x, which may drift without bound, h = eps^(1/3) L + eps^(1/2) |x|. At a corner of
/// the law, the difference is the mean slope over 2h. Relative error for a smooth law: about 1e-9. Cost: 2 evaluations
/// for every variable.
template <class S>
class Differenced final : public Equations<S> {
 public:
  explicit Differenced(std::shared_ptr<const ElementFace> law) : law_(std::move(law)) {}

  S output(const Input<S>& in, Mode mode, std::span<const S> z) const override;
  void rate(const Input<S>& in, Mode mode, std::span<const S> z, std::span<S> dz) const override;
  S respond(const Input<S>& in, Mode mode, std::span<const S> z, std::span<S> dz) const override;
  void guard(const Input<S>& in, Mode mode, std::span<const S> z, std::span<S> g) const override;
  Mode next(const Input<S>& in, Mode mode, std::span<S> z, int fired) const override;
  S storage(Mode mode, std::span<const S> z) const override;

 private:
  std::shared_ptr<const ElementFace> law_;
};

extern template class Differenced<Dual<1>>;
extern template class Differenced<Dual<4>>;

}  // namespace limcycle
