#pragma once
#include <vector>

#include "limcycle/cases/loader/case.hpp"
#include "limcycle/questions/asking/asking.hpp"
#include "limcycle/questions/asking/need_memory.hpp"

namespace limcycle {

/// Throws InputError if the points of a table, with these documents, would not fit into memory.
void need_memory_for(const DfSection& section, const HeldDocuments& held);

/// Describing functions of the case's element, from the first point on up to the first gap: fewer than points only if
/// the work was stopped. Options: those of `section`, with instruction set and threads of `asking`.
std::vector<DescribingFunction> ask_df(const Case& from, const DfSection& section, const Asking& asking,
                                       const SweepRunner& sweep);

/// The same in memory, without rows for a store: in half the time, where a kernel computes the points.
std::vector<DescribingFunction> ask_df(const Case& from, const DfSection& section, const Asking& asking);

}  // namespace limcycle
