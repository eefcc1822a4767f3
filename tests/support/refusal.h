// SPDX-License-Identifier: Apache-2.0
// What a function says when it refuses what it was given: the words of its error, or the error's code.
//
// A test of a refusal compares the words as a whole, because they are what a user has to go by: they name what is wrong
// and where. "none" is what a test finds where nothing was refused, so that it fails with both in sight.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "frontmost/base.h"

namespace frontmost::test {

/// The words of the Error that `action` throws, which must have that code; "none" where it throws none.
template <class Action>
std::string refusal_of(ErrorCode code, const Action& action) {
  try {
    action();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), code) << error.what();
    return error.what();
  }
  return "none";
}

/// The code of the Error that `action` throws, which it must.
template <class Action>
ErrorCode code_of(const Action& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.code();
  }
  ADD_FAILURE() << "nothing was refused";
  return ErrorCode::cancelled;
}

}  // namespace frontmost::test
