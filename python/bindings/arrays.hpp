#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <memory>
#include <utility>
#include <vector>

namespace crashrank::python {

namespace nb = nanobind;

// Arrays that the package's own Python code hands in: it has checked type, shape and order. The
// bindings copy what they need before they release the interpreter's lock, so that another thread
// may change or free the array meanwhile.
template <class T, class Shape>
using Given = nb::ndarray<const T, Shape, nb::c_contig, nb::device::cpu>;
using GivenPoses = Given<double, nb::shape<-1, 4, 4>>;
using GivenPaths = Given<double, nb::shape<-1, -1, 3>>;
using GivenTimes = Given<double, nb::shape<-1>>;

/// An array for numpy that owns `values`, moved here: no copy.
template <class T, class Shape>
nb::ndarray<nb::numpy, T, Shape> make_array(std::vector<T> values,
                                            std::initializer_list<std::size_t> shape) {
  auto owned = std::make_unique<std::vector<T>>(std::move(values));
  T* const data = owned->data();
  const nb::capsule keeper(owned.get(),
                           [](void* kept) noexcept { delete static_cast<std::vector<T>*>(kept); });
  owned.release();
  return nb::ndarray<nb::numpy, T, Shape>(data, shape, keeper);
}

}  // namespace crashrank::python
