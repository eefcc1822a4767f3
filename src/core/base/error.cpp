// SPDX-License-Identifier: Apache-2.0
#include <utility>

#include "frontmost/base.h"

namespace frontmost {
namespace {

/// Joins the texts that are not empty with ": ".
std::string joined(std::initializer_list<std::string_view> texts) {
  std::string all;
  for (const std::string_view text : texts) {
    if (!all.empty() && !text.empty()) all += ": ";
    all += text;
  }
  return all;
}

}  // namespace

Error::Error(ErrorCode code, std::string reason) : Error(code, "", "", std::move(reason)) {}

Error::Error(ErrorCode code, std::string place, std::string reason)
    : Error(code, "", std::move(place), std::move(reason)) {}

Error::Error(ErrorCode code, std::string file, std::string place, std::string reason)
    : std::runtime_error(joined({file, place, reason})),
      code_(code),
      parts_(std::make_shared<Parts>(Parts{std::move(file), std::move(place), std::move(reason)})) {}

Error Error::within(const std::string& file, const std::string& place) const {
  return {code_, file, joined({place, parts_->file, parts_->place}), parts_->reason};
}

}  // namespace frontmost
