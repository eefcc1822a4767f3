// SPDX-License-Identifier: Apache-2.0
// Two languages: every text is a pair, and the page shows one of them.
export type Language = "en" | "zh";
export interface Text { en: string; zh: string }

function choose(): Language {
  const asked = new URLSearchParams(location.search).get("lang") ?? localStorage.getItem("lang");
  if (asked === "en" || asked === "zh") return asked;
  return navigator.language.toLowerCase().startsWith("zh") ? "zh" : "en";
}

export const language: Language = choose();
document.documentElement.lang = language === "zh" ? "zh-Hans" : "en";

export function say(text: Text): string {
  return text[language];
}

/** Opens the page's address in the other language. */
export function switchLanguage(): void {
  const other = language === "en" ? "zh" : "en";
  localStorage.setItem("lang", other);
  const address = new URL(location.href);
  address.searchParams.set("lang", other);
  location.href = address.href;
}
