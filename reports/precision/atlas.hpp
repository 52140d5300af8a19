#pragma once
#include <string>

#include "limcycle/analysis/study/precision/stepper_atlas.hpp"
#include "limcycle/reports/format/document.hpp"
#include "limcycle/reports/format/table.hpp"
#include "limcycle/reports/provenance.hpp"

namespace limcycle {

/// In one or two sentences: steppers and tolerances that are right everywhere, and steppers that are so at none.
std::string atlas_answer(const StepperAtlas& atlas);

/// One row a stepper of this law, one column a stiffness: the largest tolerance (or step) at and below which all are
/// right, else the result at the tightest.
Table atlas_table(const StepperAtlas& atlas, const std::string& law);

std::string atlas_text(const std::string& title, const StepperAtlas& atlas);
Document atlas_document(const std::string& title, const StepperAtlas& atlas);  ///< the same, with its tables
std::string atlas_json(const Provenance& provenance, const StepperAtlas& atlas);
/// One row a run.
std::string atlas_csv(const StepperAtlas& atlas);

/// Heat map as one SVG: a row of panels a law, a panel a stepper, tolerance against stiffness, coloured and lettered by
/// the class of the run. The words of a run are the title of its cell. Readable on light and dark backgrounds.
std::string atlas_picture(const StepperAtlas& atlas);

/// A self-contained page: answer, heat map, tables, all runs.
std::string atlas_page(const StepperAtlas& atlas, const Provenance& provenance, const std::string& case_text);

}  // namespace limcycle
