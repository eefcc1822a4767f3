// SPDX-License-Identifier: Apache-2.0
// The page of one lesson.
import { bar, element, keepForLater } from "../dom.ts";
import { say } from "../language.ts";
import { moduleLoaded } from "./figure.ts";
import { lessons, type Part } from "./list.ts";

const words = { contents: { en: "All lessons", zh: "全部课程" }, of: { en: "Lesson", zh: "第" } };

function part({ title, prose, figure }: Part): HTMLElement {
  // Asterisks in texts enclose terms that a lesson introduces.
  const paragraph = (text: string) => element("p", {}, ...text.split("*").map((piece, i) => (i % 2 ? element("em", {}, piece) : piece)));
  return element("section", {}, title && element("h2", {}, say(title)), element("div", { class: "prose" }, ...prose.map((text) => paragraph(say(text)))), figure?.());
}

const asked = new URLSearchParams(location.search).get("lesson");
const number = Math.max(0, lessons.findIndex((lesson) => lesson.id === asked));
const lesson = lessons[number];
const link = (i: number, arrow: string) =>
  lessons[i] ? element("a", { href: `lesson.html?lesson=${lessons[i].id}` }, arrow === "←" ? `← ${say(lessons[i].title)}` : `${say(lessons[i].title)} →`) : element("a", { href: "lessons.html" }, say(words.contents));

document.title = `Frontmost · ${say(lesson.title)}`;
document.body.append(bar("lessons"), element("main", { class: "lesson" },
  element("header", {}, element("p", { class: "number-of" }, say({ en: `Lesson ${number + 1}`, zh: `第 ${number + 1} 课` })), element("h1", {}, say(lesson.title)), element("p", { class: "lead" }, say(lesson.lead))),
  ...lesson.parts.map(part), element("nav", { class: "pager" }, link(number - 1, "←"), link(number + 1, "→"))));
void moduleLoaded().then(keepForLater);
