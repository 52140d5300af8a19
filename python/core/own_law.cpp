#include "limcycle/python/core/own_law.hpp"

#include <pybind11/stl.h>

#include <algorithm>
#include <stdexcept>
#include <utility>
#include <vector>

#include "limcycle/cases/loader/input_error.hpp"
#include "limcycle/models/friction/own_law.hpp"

namespace limcycle::python {
namespace {

namespace py = pybind11;

[[noreturn]] void refuse(const std::string& rule) {
  throw InputError(
      {.file = {}, .line = 0, .override = {}, .key = "friction", .value = {}, .rule = rule, .suggestion = {}});
}

/// The object, released with the interpreter's lock whatever thread does it last.
using SharedObject = std::shared_ptr<py::object>;

SharedObject shared(py::object object) {
  return {new py::object(std::move(object)), [](py::object* held) {
            const py::gil_scoped_acquire lock;
            delete held;
          }};
}

[[noreturn]] void no_number(const std::string& what, const py::object& found) {
  throw py::type_error(what + ", found " +
                       (found.is_none() ? "None" : "a " + std::string(Py_TYPE(found.ptr())->tp_name)));
}

/// The object's functions as a law of the library. Its members are called without the interpreter's lock, which each
/// call takes: methods that use several threads are no faster with it.
struct PythonLaw {
  static constexpr std::string_view kind = "python-law";

  SharedObject output_of, rate_of;
  int count = 0;
  bool is_odd = false;
  Scales sizes;
  std::vector<double> state_sizes;

  int states() const { return count; }
  bool odd() const { return is_odd; }
  Scales scales() const { return sizes; }
  double state_scale(int i) const {
    return state_sizes.empty() ? sizes.displacement : state_sizes[static_cast<std::size_t>(i)];
  }
  double output(const Input<double>& in, Mode, std::span<const double> z) const {
    const py::gil_scoped_acquire lock;
    const py::object force = (*output_of)(in.v, tuple_of(z));
    try {
      return force.cast<double>();
    } catch (const py::cast_error&) {
      no_number("output(v, z) must return a number", force);
    }
  }
  void rate(const Input<double>& in, Mode, std::span<const double> z, std::span<double> dz) const {
    if (count == 0) return;
    const py::gil_scoped_acquire lock;
    const py::object rates = (*rate_of)(in.v, tuple_of(z));
    try {
      if (count == 1 && (PyFloat_Check(rates.ptr()) || PyLong_Check(rates.ptr()))) {
        dz[0] = rates.cast<double>();
        return;
      }
      const auto values = rates.cast<std::vector<double>>();
      if (values.size() != dz.size())
        throw py::value_error("rate(v, z) must return " + std::to_string(dz.size()) + " numbers, found " +
                              std::to_string(values.size()));
      std::ranges::copy(values, dz.begin());
    } catch (const py::cast_error&) {
      no_number("rate(v, z) must return " + (count == 1 ? std::string("a number") : std::to_string(count) + " numbers"),
                rates);
    }
  }

 private:
  static py::tuple tuple_of(std::span<const double> z) {
    py::tuple states(z.size());
    for (std::size_t i = 0; i < z.size(); ++i) states[i] = z[i];
    return states;
  }
};

PythonLaw law_of(const py::object& law) {
  PythonLaw made;
  if (!py::hasattr(law, "output"))
    refuse(
        "must be a dictionary, an object of limcycle.laws, or one of your own with output(v, z), the force that "
        "opposes the velocity v, and scales; found a " +
        std::string(Py_TYPE(law.ptr())->tp_name));
  if (!py::hasattr(law, "scales"))
    refuse("must have scales = (displacement, velocity, output): the sizes over which the law changes");
  made.output_of = shared(law.attr("output"));
  made.count = py::getattr(law, "states", py::int_(0)).cast<int>();
  made.is_odd = py::bool_(py::getattr(law, "odd", py::bool_(false)));
  if (made.count < 0) refuse("states must be 0 or more");
  if (made.count > 0 && !py::hasattr(law, "rate")) refuse("has states and must have rate(v, z), their rates");
  if (made.count > 0) made.rate_of = shared(law.attr("rate"));
  const auto scales = law.attr("scales").cast<std::vector<double>>();
  if (scales.size() != 3) refuse("scales must be three numbers: displacement, velocity, output");
  made.sizes = {.displacement = scales[0], .velocity = scales[1], .output = scales[2]};
  made.state_sizes = py::getattr(law, "state_scales", py::tuple()).cast<std::vector<double>>();
  if (!made.state_sizes.empty() && made.state_sizes.size() != static_cast<std::size_t>(made.count))
    refuse("state_scales must have a number for each state");
  return made;
}

}  // namespace

Element own_element(const py::object& law) {
  try {
    return own_law(law_of(law));
  } catch (const std::invalid_argument& broken) {
    refuse(broken.what());
  } catch (const py::type_error& wrong) {
    refuse(wrong.what());
  } catch (const py::cast_error&) {
    refuse("states, odd, scales and state_scales must be numbers");
  }
}

}  // namespace limcycle::python
