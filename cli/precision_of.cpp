#include "limcycle/cli/precision_of.hpp"

namespace limcycle {

PrecisionReport precision_of(const Case& from, const PrecisionOptions& options) {
  if (!from.loop) need_element(from);
  const bool friction = from.element || (from.loop && subject_of(*from.loop).opposes);
  const Element* element = from.df || friction ? &df_element(from) : nullptr;
  std::vector<DfPoint> points;
  if (from.df)
    points = representative_points(from.df->amplitude, from.df->frequency);
  else if (element != nullptr)
    points = representative_points(*element);
  return precision(from.loop ? &*from.loop : nullptr, element, points, options);
}

}  // namespace limcycle
