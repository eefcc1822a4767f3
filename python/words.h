// SPDX-License-Identifier: Apache-2.0
// Python's words for the library's enumerations: the argument "back" is Culling::back. Each enumeration states its
// words once. An unknown word causes a ValueError that lists the valid ones.
#pragma once

#include <pybind11/pybind11.h>

#include <array>
#include <string>
#include <string_view>
#include <utility>

namespace frontmost::python {

namespace py = pybind11;

/// The words of an enumeration, and its name in messages. FRONTMOST_WORDS specialises this template.
template <class E>
struct Words;

template <class E>
[[nodiscard]] E value_of(const std::string& word) {
  std::string known;
  for (const auto& [value, name] : Words<E>::all) {
    if (name == word) return value;
    known += (known.empty() ? "" : ", ") + std::string(name);
  }
  throw py::value_error(std::string(Words<E>::what) + ": '" + word + "' is not one of " + known);
}

template <class E>
[[nodiscard]] const char* word_of(E wanted) {
  for (const auto& [value, name] : Words<E>::all)
    if (value == wanted) return name.data();
  return "";
}

/// All words of an enumeration whose values count from 0. The words explain arrays of such values.
template <class E>
[[nodiscard]] py::tuple words_of() {
  py::tuple words(std::size(Words<E>::all));
  for (std::size_t i = 0; i < words.size(); ++i) words[i] = word_of(E(i));
  return words;
}

}  // namespace frontmost::python

/// FRONTMOST_WORDS(Culling, "culling", {{Culling::none, "none"}, ...}) at global scope, with frontmost:: before names,
/// defines the words of an enumeration. Bound functions then take and return it as a string.
#define FRONTMOST_WORDS(Enum, what_it_is, ...)                              \
  template <>                                                               \
  struct frontmost::python::Words<Enum> {                                   \
    static constexpr const char* what = what_it_is;                         \
    static constexpr std::pair<Enum, std::string_view> all[] = __VA_ARGS__; \
  };                                                                        \
  template <>                                                               \
  struct pybind11::detail::type_caster<Enum> {                              \
    PYBIND11_TYPE_CASTER(Enum, const_name("str"));                          \
    bool load(handle given, bool) {                                         \
      if (!isinstance<str>(given)) return false;                            \
      value = frontmost::python::value_of<Enum>(cast<std::string>(given));  \
      return true;                                                          \
    }                                                                       \
    static handle cast(Enum given, return_value_policy, handle) {           \
      return str(frontmost::python::word_of(given)).release();              \
    }                                                                       \
    template <class T>                                                      \
    static T cast(handle given) {                                           \
      return pybind11::cast<T>(given);                                      \
    }                                                                       \
  }
