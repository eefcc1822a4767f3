// SPDX-License-Identifier: Apache-2.0
// All lessons on one page.
import { bar, element, keepForLater } from "../dom.ts";
import { say } from "../language.ts";
import { lessons } from "./list.ts";

const title = { en: "How visible surfaces are found", zh: "可见面是怎样求出来的" };
const lead = {
  en: "Every figure here runs the library itself, in this page: step through it, drag it, change the scene.",
  zh: "这里的每幅图都在本页中运行真正的程序库：可以逐步播放、拖动、更换场景。",
};

document.title = `Frontmost · ${say(title)}`;
document.body.append(bar("lessons"), element("main", { class: "lesson" },
  element("header", {}, element("h1", {}, say(title)), element("p", { class: "lead" }, say(lead))),
  element("div", { class: "contents" }, ...lessons.map((lesson, i) =>
    element("a", { href: `lesson.html?lesson=${lesson.id}` }, element("span", { class: "number-of" }, String(i + 1)), element("h2", {}, say(lesson.title)), element("p", { class: "soft" }, say(lesson.lead)))))));
keepForLater();
