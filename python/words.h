// SPDX-License-Identifier: Apache-2.0
// The library's choices as words: an argument "back" is Culling::back. Each enumeration says its words once; an
// argument that is none of them ends in a ValueError that lists them.
#pragma once

#include <pybind11/pybind11.h>

#include <array>
#include <string>
#include <string_view>
#include <utility>

namespace frontmost::python {

namespace py = pybind11;

/// The words of an enumeration, and what it is called in messages. Specialised below FRONTMOST_WORDS.
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

/// All words of an enumeration whose values count from 0: what an array of such values means.
template <class E>
[[nodiscard]] py::tuple words_of() {
  py::tuple words(std::size(Words<E>::all));
  for (std::size_t i = 0; i < words.size(); ++i) words[i] = word_of(E(i));
  return words;
}

}  // namespace frontmost::python

/// FRONTMOST_WORDS(Culling, "culling", {{Culling::none, "none"}, ...}) at global scope, with frontmost:: in front of
/// names: makes words of an enumeration, and lets functions that are bound take and give it as a string.
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
