#pragma once
#include <cstddef>

#include "limcycle/analysis/study/sensitivity/global/estimate.hpp"

namespace limcycle {

/// Probability of an event that occurred in `yes` of `samples` independent samples: their share, with the 95 % score
/// interval of E. B. Wilson (J. Amer. Statist. Assoc. 22, 1927), which stays within 0..1 and has a width also for 0 or
/// all of them. Its true coverage, by summing the binomial distribution: with 20 samples 92 to 98.5 % for probabilities
/// from 0.1 to 0.9, with 200 samples 93 to 97 %; for probabilities of about 0.2 / samples it falls to 83 %. Without
/// samples: not known, 0..1. Throws std::invalid_argument if `yes` exceeds `samples`.
Estimate probability_estimate(std::size_t yes, std::size_t samples);

/// Probability of an event (that a loop hunts), from samples in which it occurred, did not, or could not be decided.
/// The points of a Sobol sequence fill the space more evenly than independent ones, so for them the interval is rather
/// too wide.
struct Probability {
  std::size_t yes = 0, no = 0, undecided = 0;
  Estimate among_decided;  ///< share of yes among yes and no: valid if undecided samples are like the others
  double low = 0.0,
         high = 1.0;  ///< for any outcome of the undecided ones: Wilson's ends with all of them no, all of them yes
};
Probability probability(std::size_t yes, std::size_t no, std::size_t undecided);

}  // namespace limcycle
