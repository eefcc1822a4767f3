// SPDX-License-Identifier: Apache-2.0
// Entry points of the module: a question as JSON, an answer as JSON.
//
//   frontmost_ask("{\"ask\": \"draw\", ...}")  ->  "{\"width\": 640, ..., \"pixels\": {\"at\": 1234, \"bytes\": 5678}}"
//                                              ->  "{\"error\": \"engine.stl: triangle 41: ...\", \"code\":
//                                              \"malformed\"}"
#include <emscripten.h>
#include <frontmost/version.h>

#include <map>

#include "web/lessons/lessons.h"
#include "web/workbench.h"

namespace frontmost::web {
namespace {

std::vector<std::byte>& room() {
  static std::vector<std::byte> bytes;
  return bytes;
}

/// Takes the bytes that the page has provided.
std::vector<std::byte> take_room() { return std::exchange(room(), {}); }

Workbench& workbench() {
  static Workbench made;
  return made;
}

using AnswerFunction = PlainJson (*)(const PlainJson& question);

template <PlainJson (Workbench::*answer)(const PlainJson&)>
PlainJson by_workbench(const PlainJson& question) {
  return (workbench().*answer)(question);
}

const std::map<std::string, AnswerFunction, std::less<>>& answers() {
  static const std::map<std::string, AnswerFunction, std::less<>> made = {
      {"about",
       [](const PlainJson&) {
         return PlainJson{{"version", FRONTMOST_VERSION}, {"isa", name(Isa::best)}, {"builtin", builtin_names()}};
       }},
      {"open", [](const PlainJson& question) { return workbench().open(take_room(), question); }},
      {"file", [](const PlainJson& question) { return workbench().put_file(take_room(), question); }},
      {"image", [](const PlainJson& question) { return workbench().put_image(take_room(), question); }},
      {"compare", [](const PlainJson& question) { return workbench().compare(take_room(), question); }},
      {"lesson.open", [](const PlainJson& question) { return open_lesson(take_room(), question); }},
      {"builtin", by_workbench<&Workbench::open_builtin>},
      {"frame", by_workbench<&Workbench::frame>},
      {"draw", by_workbench<&Workbench::draw>},
      {"edges", by_workbench<&Workbench::edges>},
      {"point", by_workbench<&Workbench::point>},
      {"report", by_workbench<&Workbench::report>},
      {"sphere", by_workbench<&Workbench::sphere>},
      {"write", by_workbench<&Workbench::write>},
      {"conventions", by_workbench<&Workbench::conventions>},
      {"triangles", by_workbench<&Workbench::triangles>},
      {"lesson.frame", frame_lesson},
      {"lesson.zbuffer", zbuffer_lesson},
      {"lesson.culling", culling_lesson},
      {"lesson.projection", projection_lesson},
      {"lesson.painter", painter_lesson},
      {"lesson.newell", newell_lesson},
      {"lesson.bsp", bsp_lesson},
      {"lesson.rays", rays_lesson},
      {"lesson.layers", layers_lesson},
      {"lesson.lines", lines_lesson},
      {"lesson.clipping", clipping_lesson},
      {"lesson.shadows", shadows_lesson},
      {"lesson.occlusion", occlusion_lesson},
      {"lesson.methods", methods_lesson},
  };
  return made;
}

PlainJson answer_to(const std::string& text) {
  try {
    const PlainJson question = PlainJson::parse(text);
    const std::string ask = question.at("ask");
    const auto found = answers().find(ask);
    if (found == answers().end()) throw Error(ErrorCode::bad_argument, "there is no '" + ask + "'");
    return found->second(question);
  } catch (const Error& error) {
    return {{"error", utf8_text(error.what())}};
  } catch (const std::bad_alloc&) {
    return {{"error", "there is not enough memory"}};
  } catch (const std::exception& error) {
    return {{"error", utf8_text(error.what())}};
  }
}

}  // namespace
}  // namespace frontmost::web

extern "C" {

/// Memory for the bytes that the next question brings: a file, or pixels. Null if memory is exhausted.
EMSCRIPTEN_KEEPALIVE void* frontmost_room(std::size_t bytes) {
  try {
    frontmost::web::room().reserve(bytes + 1);  // one byte more, since a file may be empty
    frontmost::web::room().resize(bytes);
    return frontmost::web::room().data();
  } catch (const std::exception&) {
    return nullptr;
  }
}

/// Answers a question. The text is valid until the next question.
EMSCRIPTEN_KEEPALIVE const char* frontmost_ask(const char* question) {
  static std::string answer;
  answer = frontmost::web::answer_to(question).dump();
  return answer.c_str();
}
}
