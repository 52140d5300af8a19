#pragma once
#include <Eigen/Core>
#include <limits>
#include <optional>

#include "limcycle/models/linear/state_space.hpp"

/// @file
/// Properties of a transfer function H(s) = C (sI - A)^-1 B + D of one input and one output without a grid of
/// frequencies: its relevant modes, its zeros, its inverse. All in state space, by orthogonal transformations, since
/// coefficients of polynomials lose the small numbers of a stiff loop.
///
/// Numbers that are small differences of large ones do not show by their own size what of them is rounding: `A_size` is
/// the size of the terms that form A, if larger than that of A.

namespace limcycle {

/// A realisation in which every mode is controllable and observable.
struct Minimal {
  StateSpace H;
  Eigen::VectorXcd hidden;  ///< eigenvalues of the modes left out
};

/// Diagonal scaling, then the controllable and observable part by Householder's staircase. A coupling below 1e-13 of
/// the matrix counts as zero. Cost O(n^3).
Minimal minimal(const StateSpace& H, double A_size = 0.0);

/// Finite zeros of a transfer function, those of hidden modes included; empty optional if it vanishes identically. By
/// reduction: with D != 0 they are the eigenvalues of A - B C/D; with D = 0 the zero dynamics of the output, with one
/// state fewer at a time (Emami-Naeini and Van Dooren 1982). Pivots below 1e-13 of their terms count as zero. Cost
/// O(n^4).
std::optional<Eigen::VectorXcd> zeros(const StateSpace& of);

/// 1/H(s) = slope s + proper(s).
struct Inverse {
  double slope = 0.0;
  StateSpace proper;
  struct {
    double A = 0.0, D = 0.0;
  } made_of;  ///< sizes of the terms of proper.A and proper.D
};

/// Inverse of a transfer function with relative degree 0 or 1; empty for a higher one (or for H = 0). Exact, by
/// eliminating the output as a state: `proper` has one state fewer, and its poles are the zeros. Cost O(n^2).
std::optional<Inverse> inverse(const StateSpace& of);

/// H(s) split into its pole at the origin and the rest: H = residue/s + rest.
struct OriginPole {
  int order = 0;  ///< multiplicity of the pole; `rest` and `residue` are valid for 0 and 1
  double residue = 0.0;
  StateSpace rest;
};

/// For a minimal H, by rank decisions, sharper than eigenvalues (a double one splits by the square root of rounding).
OriginPole without_origin_pole(const StateSpace& of, double A_size = 0.0);

/// A in other units of the states, powers of two, that make its rows as large as its columns (Parlett and Reinsch
/// 1969): the eigenvalues are the same, but accurate to rounding of their own terms. Cost O(n^2).
Eigen::MatrixXd balanced(const Eigen::MatrixXd& A);

/// Zero eigenvalues of A: multiplicity, and number of eigenvectors. `times` above `directions`: something drifts.
struct ZeroModes {
  int times = 0, directions = 0;
};

/// By rank decisions as above. Cost O(n^4).
ZeroModes zero_modes(const Eigen::MatrixXd& A, double A_size = 0.0);

}  // namespace limcycle
