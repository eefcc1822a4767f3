// SPDX-License-Identifier: Apache-2.0
// The message or code of the error by which a function refuses its arguments.
//
// Tests of refusals compare whole messages, because users rely on them: a message names the fault and its place. "none"
// stands for no error, so that a failing test shows both texts.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "frontmost/base.h"

namespace frontmost::test {

/// The message of the Error that `action` throws, which must have this code; "none" if it throws none.
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

/// The code of the Error that `action` must throw.
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
