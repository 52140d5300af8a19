// The extension module limcycle._core. Its functions are wrapped by the package, which documents them; the names here
// are for that package alone.
#include <pybind11/complex.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include "limcycle/cases/loader/case_numbers.hpp"
#include "limcycle/python/core/answers.hpp"
#include "limcycle/python/core/own_law.hpp"
#include "limcycle/python/core/work.hpp"
#include "limcycle/questions/asking/answer_of.hpp"
#include "limcycle/questions/asking/provenance_of.hpp"
#include "limcycle/reports/case_files/laws.hpp"
#include "limcycle/reports/export/hdf5.hpp"

namespace limcycle::python {
namespace {

namespace py = pybind11;
using CasePointer = std::shared_ptr<const Case>;

/// Raises limcycle.CaseError.
void raise(const InputFault& fault) {
  const py::object kind = py::module_::import("limcycle._errors").attr("CaseError");
  const py::object error =
      kind(fault.key, fault.value, fault.rule, fault.suggestion, fault.file, fault.line, fault.override);
  PyErr_SetObject(kind.ptr(), error.ptr());
}

void translate(std::exception_ptr thrown) {
  try {
    if (thrown) std::rethrow_exception(thrown);
  } catch (const InputError& error) {
    raise(error.fault());
  } catch (const NoAnswer& error) {
    PyErr_SetString(py::module_::import("limcycle._errors").attr("NoAnswer").ptr(), error.what());
  }
}

/// Takes the numbers over; read-only, since results share them.
template <class Number>
py::array_t<Number> array_of(const std::vector<std::size_t>& shape, std::vector<Number> values) {
  auto* kept = new std::vector<Number>(std::move(values));
  const py::capsule owner(kept, [](void* numbers) { delete static_cast<std::vector<Number>*>(numbers); });
  py::array_t<Number> array(shape, kept->data(), owner);
  array.attr("flags").attr("writeable") = false;
  return array;
}

py::dict numpy_arrays(const Answer& answer) {
  py::dict arrays;
  if (!answer.arrays) return arrays;
  std::map<std::string, Array> found;
  {
    const py::gil_scoped_release unlocked;
    found = answer.arrays();
  }
  for (auto& [name, array] : found) {
    const auto& shape = array.shape;
    arrays[py::str(name)] =
        std::visit([&shape](auto& values) -> py::object { return array_of(shape, std::move(values)); }, array.values);
  }
  return arrays;
}

/// A document, made without the interpreter's lock; None if the question has none.
py::object document(const std::function<std::string()>& make) {
  if (!make) return py::none();
  std::string text;
  {
    const py::gil_scoped_release unlocked;
    text = make();
  }
  return py::str(text);
}

Isa isa_of(const std::string& name) {
  std::vector<std::string> known{"auto"};
  for (const Isa isa : all_isas())
    if (is_available(isa)) known.emplace_back(to_string(isa));
  const auto isa = isa_named(name);
  if (isa && is_available(*isa)) return *isa;
  throw InputError({.file = {},
                    .line = 0,
                    .override = {},
                    .key = "isa",
                    .value = '"' + name + '"',
                    .rule = "is not an instruction set of this machine",
                    .suggestion = suggest(name, known)});
}

void define_cases(py::module_& module) {
  py::class_<Case, std::shared_ptr<Case>>(module, "Case")
      .def_readonly("title", &Case::title)
      .def_readonly("file", &Case::file)
      .def_readonly("text", &Case::text)
      .def_readonly("overrides", &Case::overrides)
      .def_property_readonly("has_df", [](const Case& from) { return from.df.has_value(); })
      .def_property_readonly("has_simulate", [](const Case& from) { return from.simulate.has_value(); })
      .def("numbers", [](const Case& from) {
        py::list list;
        for (const auto& one : numbers_of(from))
          list.append(py::make_tuple(one.path, one.unit, one.meaning, one.value));
        return list;
      });
  module.def("load_case", [](const std::string& file, const std::vector<std::string>& overrides) {
    return std::make_shared<Case>(load_case(file, overrides));
  });
  module.def("read_case", [](const std::string& text, const std::string& file,
                             const std::vector<std::string>& overrides, const py::object& own) {
    const std::optional<Element> law = own.is_none() ? std::nullopt : std::optional(own_element(own));
    return std::make_shared<Case>(read_case(text, file, overrides, law));
  });
  module.def("read_again", [](const Case& from, const std::vector<std::string>& overrides) {
    return std::make_shared<Case>(read_again(from, overrides));
  });
  module.def("laws", [] { return laws_json(provenance_of(0, 1, nullptr), catalogue()); });
  module.attr("version") = provenance_of(0, 1, nullptr).version;
}

void define_work(py::module_& module) {
  module.def("hdf5", [](const std::string& json) { return py::bytes(hdf5_document(json)); });
  py::class_<Work>(module, "Work")
      .def(py::init([](std::uint64_t seed, int threads, const std::string& isa, double limit, py::object progress) {
        return Work{seed, threads, isa_of(isa), limit, std::move(progress)};
      }));
  py::class_<Answer>(module, "Answer")
      .def("json", [](const Answer& answer) { return document(answer.json); })
      .def("csv", [](const Answer& answer) { return document(answer.csv); })
      .def("text", [](const Answer& answer) { return document(answer.text); })
      .def("latex", [](const Answer& answer) { return document(answer.latex); })
      .def("picture", [](const Answer& answer) { return document(answer.picture); })
      .def("page", [](const Answer& answer) { return document(answer.page); })
      .def("arrays", &numpy_arrays)
      .def_readonly("columns", &Answer::columns)
      .def_property_readonly("has_picture", [](const Answer& answer) { return static_cast<bool>(answer.picture); })
      .def_property_readonly("has_page", [](const Answer& answer) { return static_cast<bool>(answer.page); })
      .def("applied",
           [](const Answer& answer, const std::string& name) { return std::make_shared<Case>(answer.applied(name)); });
}

/// Defines a question of this name: `ask(question, arguments...)` answers it.
template <class... Arguments>
void define_question(py::module_& module, const char* name, Answer (*ask)(const Question&, Arguments...)) {
  module.def(name, [ask](const CasePointer& from, const Work& work, const std::decay_t<Arguments>&... arguments) {
    return answer_to(from, work, [&](const Question& question) { return ask(question, arguments...); });
  });
}

using Side = std::tuple<std::string, double, double, int, bool>;

MapAxis axis_of(const Side& side) {
  const auto& [path, from, to, points, logarithmic] = side;
  return {path, from, to, points, logarithmic};
}

Answer map_of(const Question& question, const Side& x, const Side& y, const std::vector<std::string>& methods,
              bool outcomes, int starts) {
  return map_answer(question, axis_of(x), axis_of(y), methods, outcomes, starts);
}

Answer sensitivity_of(const Question& question, int samples, int trajectories, bool second_order,
                      const std::vector<double>& factors, bool local, const std::vector<std::string>& thresholds) {
  return sensitivity_answer(question, {samples, trajectories, second_order, factors, local, thresholds});
}

Answer dissipativity_of(const Question& question, double speed, double top_speed, const std::string& path, double from,
                        double to) {
  return dissipativity_answer(question, {speed, top_speed, path, from, to});
}

Answer remedy_of(const Question& question, const std::vector<std::string>& only,
                 const std::map<std::string, double>& weights, std::size_t samples) {
  RemedyWishes wishes{only, {}, samples};
  for (const auto& [name, weight] : weights) wishes.weights[cost_named("weights", name)] = weight;
  return remedy_answer(question, wishes);
}

using Bounds = std::tuple<std::string, double, double>;

Answer tune_of(const Question& question, const std::vector<Bounds>& vary, const std::string& minimise,
               const std::map<std::string, double>& at_most, double horizon, double margin, std::size_t samples) {
  TuneWishes wishes;
  for (const auto& [name, low, high] : vary) wishes.vary.push_back({name, low, high});
  wishes.minimised = tune_cost_named("minimise", minimise);
  for (const auto& [name, limit] : at_most)
    wishes.limits[static_cast<std::size_t>(tune_cost_named("at_most", name))] = limit;
  wishes.horizon = horizon;
  wishes.margin = margin;
  wishes.samples = samples;
  return tune_answer(question, wishes);
}

}  // namespace

PYBIND11_MODULE(_core, module) {
  py::register_exception_translator(&translate);
  define_cases(module);
  define_work(module);
  define_question(module, "predict", &predict_answer);
  define_question(module, "df", &df_answer);
  define_question(module, "simulate", &simulate_answer);
  define_question(module, "continue_", &continue_answer);
  define_question(module, "margin", &margin_answer);
  define_question(module, "map", &map_of);
  define_question(module, "sensitivity", &sensitivity_of);
  define_question(module, "dissipativity", &dissipativity_of);
  define_question(module, "remedy", &remedy_of);
  define_question(module, "tune", &tune_of);
  define_question(module, "identify", &identify_answer);
}

}  // namespace limcycle::python
