#pragma once
#include "limcycle/python/core/answer.hpp"
#include "limcycle/questions/dissipativity.hpp"
#include "limcycle/questions/map.hpp"
#include "limcycle/questions/margin.hpp"
#include "limcycle/questions/remedy.hpp"
#include "limcycle/questions/sensitivity.hpp"
#include "limcycle/questions/tune.hpp"

namespace limcycle::python {

// One function a question. Each throws InputError for a wrong one, NoAnswer if a method cannot handle the numbers.

Answer predict_answer(const Question& question);
/// Describing functions over the grid of [df]. The arrays have its shape, amplitude x frequency x bias; NaN where the
/// document has null.
Answer df_answer(const Question& question);
Answer simulate_answer(const Question& question, bool check, bool audit);
Answer continue_answer(const Question& question, const std::string& path, double low, double high);
Answer margin_answer(const Question& question, const std::vector<std::string>& paths, double factor,
                     const std::vector<Toward>& toward);
Answer map_answer(const Question& question, const MapAxis& x, const MapAxis& y, const std::vector<std::string>& methods,
                  bool outcomes, int starts);
Answer sensitivity_answer(const Question& question, const SensitivityWishes& wishes);
Answer dissipativity_answer(const Question& question, const DissipativityWishes& wishes);
Answer remedy_answer(const Question& question, const RemedyWishes& wishes);
Answer tune_answer(const Question& question, const TuneWishes& wishes);
Answer identify_answer(const Question& question, bool plan);

}  // namespace limcycle::python
