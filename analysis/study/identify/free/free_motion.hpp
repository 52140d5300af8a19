#pragma once
#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "limcycle/analysis/study/identify/record/record.hpp"
#include "limcycle/models/linear/plants.hpp"

namespace limcycle {

/// The rig of free motions: a plant with two states, which its output y and dy/dt determine, and a constant force.
struct FreeRig {
  PlantModel plant;
  double load = 0.0;  ///< added to the applied force, N
};

/// Why a plant cannot move freely here, as a sentence after its name; nothing if it can.
std::optional<std::string> why_no_free_rig(const PlantModel& plant);

/// An instant at which the input may bend or a row is compared.
struct FreeStop {
  double t = 0.0;              ///< s from the first row
  double u = 0.0;              ///< applied force and load, N
  std::ptrdiff_t sample = -1;  ///< of `compared` in the prepared records; -1: none
};

/// A part of a free motion that is simulated from its own start.
struct FreeWindow {
  std::size_t first = 0, last = 0;  ///< stops, both included
  Eigen::Vector2d start;            ///< the state there, read off the rows
  bool sliding = false;             ///< the contact slid before the start; else it rests there
};

/// A record of a free motion: what drives the rig, and its states as read off the measured rows.
struct FreeMotion {
  FreeRig rig;
  std::vector<FreeStop> stops;
  bool holds_force = false;               ///< u keeps its value until the next stop, else it is linear
  std::vector<Eigen::Vector2d> states;    ///< at the stops
  Eigen::Vector2d state_sizes;            ///< range of each state
  double rubbing_speed = 0.0;             ///< largest, m/s
  std::vector<FreeWindow> whole, pieces;  ///< the motion in one window, and in several; each window begins where the
                                          ///< rig is fast, so that the contact slides

  std::size_t samples() const;
};

/// Positions and velocities that were measured (one prepared record each) with their motion. States are those of
/// least-squares parabolas over neighbouring rows, as many as an eighth of a swing has, 400 at most. The friction
/// force, whose size the search for a law begins with, follows from them and the equation of motion. Throws
/// std::invalid_argument with a sentence: see check_in_time(); more than 100000 rows; a body that does not move. Cost:
/// linear in the rows.
std::vector<PreparedRecord> prepare_free(const FrictionRecord& record, const FreeRig& rig);

}  // namespace limcycle
