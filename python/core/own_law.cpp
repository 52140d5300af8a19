#include "limcycle/python/core/own_law.hpp"

#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <mutex>
#include <stdexcept>
#include <utility>
#include <vector>

#include "limcycle/cases/loader/text/input_error.hpp"
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

/// What Python keeps of threads that have ended. A thread does not free its own: it would have to wait for the lock,
/// and if the interpreter ended meanwhile, Python would end the process. The next thread that comes with the lock does.
class EndedThreads {
 public:
  static EndedThreads& all() {
    static EndedThreads& kept = *new EndedThreads;  // outlives every thread
    return kept;
  }
  void add(PyThreadState* state) {
    const std::lock_guard lock(guard_);
    states_.push_back(state);
  }
  /// With the interpreter's lock.
  void release() {
    std::vector<PyThreadState*> ended;
    {
      const std::lock_guard lock(guard_);
      ended.swap(states_);
    }
    for (PyThreadState* state : ended) {
      PyThreadState_Clear(state);
      PyThreadState_Delete(state);
    }
  }

 private:
  std::mutex guard_;
  std::vector<PyThreadState*> states_;
};

/// The lock of the interpreter, for a call of the law. What Python keeps of a thread that is not its own stays until
/// the thread ends: to make and to free it with every call takes twenty times as long as the call.
class LawLock {
 public:
  LawLock() {
    if (!unknown_) return;
    EndedThreads::all().release();
    thread_local const Kept kept{PyThreadState_Get()};
    lock_.inc_ref();
  }

 private:
  struct Kept {
    explicit Kept(PyThreadState* own) : state(own) {}
    Kept(const Kept&) = delete;
    Kept& operator=(const Kept&) = delete;
    ~Kept() { EndedThreads::all().add(state); }
    PyThreadState* state;
  };
  bool unknown_ = PyGILState_GetThisThreadState() == nullptr;  ///< to Python, before the lock
  py::gil_scoped_acquire lock_;
};

[[noreturn]] void no_number(const std::string& what, const py::object& found) {
  throw py::type_error(what + ", found " +
                       (found.is_none() ? "None" : "a " + std::string(Py_TYPE(found.ptr())->tp_name)));
}

/// What a law of Python states about itself.
struct Stated {
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
};

/// The object's functions as a law of the library. Its members are called without the interpreter's lock, which each
/// call takes: methods that use several threads are no faster with it.
struct PythonLaw : Stated {
  static constexpr std::string_view kind = "python-law";

  SharedObject output_of, rate_of;

  double output(const Input<double>& in, Mode, std::span<const double> z) const {
    const LawLock lock;
    const py::object force = called(*output_of, in.v, z);
    if (PyFloat_CheckExact(force.ptr())) return PyFloat_AS_DOUBLE(force.ptr());
    try {
      return force.cast<double>();
    } catch (const py::cast_error&) {
      no_number("output(v, z) must return a number", force);
    }
  }
  void rate(const Input<double>& in, Mode, std::span<const double> z, std::span<double> dz) const {
    if (count == 0) return;
    const LawLock lock;
    const py::object rates = called(*rate_of, in.v, z);
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
  /// function(v, z), by the protocol that costs least: the call takes longer than many a law.
  static py::object called(const py::object& function, double v, std::span<const double> z) {
    const py::object velocity = number(v);
    const py::tuple states(z.size());
    for (std::size_t i = 0; i < z.size(); ++i)
      PyTuple_SET_ITEM(states.ptr(), static_cast<Py_ssize_t>(i), number(z[i]).release().ptr());
    const std::array<PyObject*, 2> arguments{velocity.ptr(), states.ptr()};
    PyObject* const answer = PyObject_Vectorcall(function.ptr(), arguments.data(), arguments.size(), nullptr);
    if (answer == nullptr) throw py::error_already_set();
    return py::reinterpret_steal<py::object>(answer);
  }
  static py::object number(double value) {
    PyObject* const made = PyFloat_FromDouble(value);
    if (made == nullptr) throw py::error_already_set();
    return py::reinterpret_steal<py::object>(made);
  }
};

/// A law whose functions are machine code, as Numba and ctypes have it: no call needs the interpreter.
struct CompiledLaw : Stated {
  static constexpr std::string_view kind = "compiled-law";

  double (*output_of)(double v, const double* z) = nullptr;
  void (*rate_of)(double v, const double* z, double* dz) = nullptr;
  SharedObject code;  ///< whose functions they are

  double output(const Input<double>& in, Mode, std::span<const double> z) const { return output_of(in.v, z.data()); }
  void rate(const Input<double>& in, Mode, std::span<const double> z, std::span<double> dz) const {
    if (count > 0) rate_of(in.v, z.data(), dz.data());
  }
};

/// Where the code of a function of Numba (cfunc) or ctypes stands; 0 for one that Python has to call.
std::uintptr_t address_of(const py::object& function) {
  if (py::hasattr(function, "address")) return function.attr("address").cast<std::uintptr_t>();
  if (!py::hasattr(function, "argtypes") || !py::hasattr(function, "restype")) return 0;
  const auto ctypes = py::module_::import("ctypes");
  return ctypes.attr("cast")(function, ctypes.attr("c_void_p")).attr("value").cast<std::uintptr_t>();
}

Stated stated_by(const py::object& law) {
  if (!py::hasattr(law, "output"))
    refuse(
        "must be a dictionary, an object of limcycle.laws, or one of your own with output(v, z), the force that "
        "opposes the velocity v, and scales; found a " +
        std::string(Py_TYPE(law.ptr())->tp_name));
  if (!py::hasattr(law, "scales"))
    refuse("must have scales = (displacement, velocity, output): the sizes over which the law changes");
  Stated made;
  made.count = py::getattr(law, "states", py::int_(0)).cast<int>();
  made.is_odd = py::bool_(py::getattr(law, "odd", py::bool_(false)));
  constexpr int most_states = 1000;
  if (made.count < 0 || made.count > most_states)
    refuse("states must be 0 to " + std::to_string(most_states) + ", not " + std::to_string(made.count));
  if (made.count > 0 && !py::hasattr(law, "rate")) refuse("has states and must have rate(v, z), their rates");
  const auto scales = law.attr("scales").cast<std::vector<double>>();
  if (scales.size() != 3) refuse("scales must be three numbers: displacement, velocity, output");
  made.sizes = {.displacement = scales[0], .velocity = scales[1], .output = scales[2]};
  made.state_sizes = py::getattr(law, "state_scales", py::tuple()).cast<std::vector<double>>();
  if (!made.state_sizes.empty() && made.state_sizes.size() != static_cast<std::size_t>(made.count))
    refuse("state_scales must have a number for each state");
  return made;
}

Element element_of(const py::object& law) {
  const Stated stated = stated_by(law);
  const py::object output = law.attr("output");
  py::object rate = py::none();
  if (stated.count > 0) rate = law.attr("rate");
  const std::uintptr_t output_at = address_of(output), rate_at = address_of(rate);
  if (stated.count > 0 && (output_at == 0) != (rate_at == 0))
    refuse("output and rate must both be compiled, or neither");
  if (output_at == 0) {
    PythonLaw made{stated, shared(output), {}};
    if (stated.count > 0) made.rate_of = shared(rate);
    return own_law(made);
  }
  // NOLINTBEGIN(performance-no-int-to-ptr): Python hands functions over as numbers
  return own_law(CompiledLaw{stated, reinterpret_cast<decltype(CompiledLaw::output_of)>(output_at),
                             reinterpret_cast<decltype(CompiledLaw::rate_of)>(rate_at), shared(law)});
  // NOLINTEND(performance-no-int-to-ptr)
}

}  // namespace

Element own_element(const py::object& law) {
  try {
    return element_of(law);
  } catch (const std::invalid_argument& broken) {
    refuse(broken.what());
  } catch (const py::type_error& wrong) {
    refuse(wrong.what());
  } catch (const py::cast_error&) {
    refuse("states, odd, scales and state_scales must be numbers");
  }
}

}  // namespace limcycle::python
