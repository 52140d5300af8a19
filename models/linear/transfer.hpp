#pragma once
#include <Eigen/Core>
#include <limits>
#include <optional>

#include "limcycle/models/linear/state_space.hpp"

/// @file
/// What may be said of a transfer function H(s) = C (sI - A)^-1 B + D of one input and one output without gridding
/// frequencies: which of its modes count, where it vanishes, what its inverse is. All in state space, by orthogonal
/// transformations, since the coefficients of polynomials lose what a stiff loop has in small numbers.
///
/// Where numbers are the small difference of large ones, their own size does not tell what of them is rounding:
/// `A_size` is that of what A was made of, if more than its own.

namespace limcycle {

/// A realisation in which every mode is reached by the input and seen in the output.
struct Minimal {
  StateSpace H;
  Eigen::VectorXcd hidden;  ///< eigenvalues of the modes left out
};

/// Diagonal scaling, then the controllable and observable part by Householder's staircase. A coupling below 1e-13 of
/// the matrix counts as none. Cost O(n^3).
Minimal minimal(const StateSpace& H, double A_size = 0.0);

/// Finite zeros of a transfer function, those of hidden modes included; empty optional if it vanishes identically. By
/// reduction: with D != 0 they are the eigenvalues of A - B C/D; with D = 0 the output's zero dynamics, a state less at
/// a time (Emami- Naeini and Van Dooren 1982). Pivots below 1e-13 of what they are made of count as zero. Cost O(n^4).
std::optional<Eigen::VectorXcd> zeros(const StateSpace& of);

/// 1/H(s) = slope s + proper(s).
struct Inverse {
  double slope = 0.0;
  StateSpace proper;
  struct {
    double A = 0.0, D = 0.0;
  } made_of;  ///< sizes of the terms of proper.A and proper.D
};

/// Inverse of a transfer function with relative degree 0 or 1; nothing for a higher one (or for 0). Exact, by
/// eliminating the state that the output is: `proper` has a state less, its poles being the zeros. Cost O(n^2).
std::optional<Inverse> inverse(const StateSpace& of);

/// H(s) with its pole at the origin taken out: H = residue/s + rest.
struct OriginPole {
  int order = 0;  ///< multiplicity of the pole; `rest` and `residue` are good for 0 and 1
  double residue = 0.0;
  StateSpace rest;
};

/// Of a minimal H, by rank decisions, which are sharper than eigenvalues (a double one splits by the root of rounding).
OriginPole without_origin_pole(const StateSpace& of, double A_size = 0.0);

/// A in other units of the states, powers of two, that make its rows as large as its columns (Parlett and Reinsch
/// 1969): eigenvalues are the same, but right to rounding of what they are made of. Cost O(n^2).
Eigen::MatrixXd balanced(const Eigen::MatrixXd& A);

/// Zero eigenvalues of A: how often, and in how many directions. `times` beyond `directions`: something drifts.
struct ZeroModes {
  int times = 0, directions = 0;
};

/// By rank decisions as above. Cost O(n^4).
ZeroModes zero_modes(const Eigen::MatrixXd& A, double A_size = 0.0);

}  // namespace limcycle
