#pragma once
#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

#include "limcycle/analysis/status.hpp"
#include "limcycle/models/loop.hpp"

namespace limcycle {

/// Number of harmonics and stopping criteria of a harmonic balance.
struct HarmonicBalanceOptions {
  int max_harmonics = 75;  ///< 1..400
  double accuracy = 1e-9;  ///< of the scaled equations, 1e-12..1e-3
  double tail = 1e-6;  ///< wanted size of the highest third of the harmonics of y and of what rubs over the first, > 0
  bool half_wave_symmetric = false;  ///< odd harmonics only: every element is odd and none is biased at the rest point
  int max_iterations = 30;           ///< of Newton's method for each number of harmonics
  long max_evaluations = 1'000'000;  ///< of the elements' equations, all together, > 0
  std::function<bool()> stop;        ///< called between evaluations; true ends the search
};

/// Start of a harmonic balance. Coefficients as in HarmonicBalance.
struct HarmonicGuess {
  double frequency = 0.0;  ///< rad/s
  Eigen::VectorXcd first;  ///< first harmonic of each element's input; 0: follows from the last (main) element
  Eigen::VectorXd mean;    ///< of each element's input; empty: order 0 of `inputs`, else that of the rest point. No
                           ///< effect for a friction law that rubs, whose mean rate follows from the loop
  std::vector<Eigen::VectorXcd> inputs;  ///< instead of `first`: orders 0..H of each element's input; begins at that H
};

/// A periodic motion by its harmonics. A coefficient of order n is b + j a for b sin(n w t) + a cos(n w t), one of
/// order 0 is j times the mean.
struct HarmonicBalance {
  Status status = Status::stalled;
  std::string why;                                ///< a sentence, unless converged
  double frequency = 0.0;                         ///< rad/s
  int harmonics = 0;                              ///< H; 0: none was found, and the numbers are 0
  std::vector<Eigen::VectorXcd> inputs, outputs;  ///< of each element, index n = order, 0..H
  Eigen::VectorXd mean_rates;                     ///< mean rate of each element's input (rubbing velocity), per s
  Eigen::VectorXcd y;                             ///< 0..H
  double amplitude = 0.0;                         ///< half the peak-to-peak of y
  double first_harmonic = 0.0;                    ///< amplitude of y's first harmonic
  double offset = 0.0;                            ///< mean of y
  double tail = 0.0;      ///< tail that was reached, see HarmonicBalanceOptions::tail; 1 if H is 1
  double change = 1.0;    ///< relative change of frequency or y's first harmonic, the larger one, by the orders added
                          ///< last; 1 if only one number of harmonics had a balance
  double residual = 0.0;  ///< largest scaled defect of the equations, on finer panels than they were solved on
  long evaluations = 0;   ///< of the elements' equations
};

/// Harmonic balance of a loop with any number of elements: the inputs' harmonics and the frequency that reproduce
/// themselves through the elements' periodic outputs and the exact response of the linear part, delay included (see
/// BalanceEquations). With one harmonic this is the describing function. The element's response to several harmonics is
/// integrated between its switches and reversals (harmonic_response), so the only approximation is that harmonics above
/// H are left out. Of measured plants it takes the fits: harmonics reach beyond the data.
///
/// Damped Newton's method for H = 1, 3, 5, 9, 15, 25, 45, 75, ..., each started from the one before, until the tail is
/// small. Status: converged; incomplete if the tail did not fall below options.tail by max_harmonics, or the last
/// orders failed; stalled or max_iterations if there was no balance from this guess; interrupted. Harmonics converge
/// slowly for a body that sticks: expect `incomplete` there. A set-valued law (Coulomb) never sticks here, because its
/// input is prescribed.
///
/// Throws std::invalid_argument quoting what is out of range, or if half_wave_symmetric is requested for a loop with an
/// element that is not odd. Cost: some 100 periods of each element; tens of milliseconds.
HarmonicBalance harmonic_balance(const Loop& loop, const HarmonicGuess& guess,
                                 const HarmonicBalanceOptions& options = {});

}  // namespace limcycle
