#pragma once
#include <pybind11/pybind11.h>

#include "limcycle/models/element/element.hpp"

namespace limcycle::python {

/// An object of Python as a friction law. It has `output(v, z)`, `scales` = (displacement, velocity, output), and, if
/// it has a state, `states` and `rate(v, z)`; `odd` and `state_scales` are optional. Throws InputError for what is
/// missing, and for what own_law() refuses.
Element own_element(const pybind11::object& law);

}  // namespace limcycle::python
