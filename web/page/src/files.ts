// SPDX-License-Identifier: Apache-2.0
// Files that are dropped or chosen: a model, and the files that it names, beside it or in folders below.
import type { Answer } from "./answer.ts";
import type { Client } from "./client.ts";

export interface NamedFile { name: string; file: File }

/** Suffixes of models and of the files that they name. If there are several models, the first suffix wins. */
const models = [".glb", ".gltf", ".obj", ".stl", ".ply", ".off"];
const named = [...models, ".mtl", ".bin", ".png", ".jpg", ".jpeg"];
export const accepted = named.join(",");
/** A folder with more files is not a model's folder. */
const mostFiles = 5000;
const rank = ({ name }: NamedFile) => {
  const of = models.findIndex((suffix) => name.toLowerCase().endsWith(suffix));
  return of < 0 ? Infinity : of + 100 * name.split("/").length;
};

/** Adds a file to `found`, or the files of a folder that may belong to a model. */
async function find(entry: FileSystemEntry, path: string, found: NamedFile[]): Promise<void> {
  if (entry.isFile) {
    if (path !== "" && !named.some((suffix) => entry.name.toLowerCase().endsWith(suffix))) return;
    if (found.length === mostFiles) throw new Error(`${path}: more than ${mostFiles} files`);
    const file = await new Promise<File>((take, fail) => (entry as FileSystemFileEntry).file(take, fail));
    found.push({ name: path + entry.name, file });
    return;
  }
  const reader = (entry as FileSystemDirectoryEntry).createReader();
  for (;;) {
    const some = await new Promise<FileSystemEntry[]>((take, fail) => reader.readEntries(take, fail));
    if (some.length === 0) return;
    for (const one of some) await find(one, `${path}${entry.name}/`, found);
  }
}

/** All dropped files, including those in folders. Must be called before any await. */
export async function dropped(transfer: DataTransfer): Promise<NamedFile[]> {
  const entries = [...transfer.items].map((item) => item.webkitGetAsEntry?.()).filter((entry) => entry !== null && entry !== undefined);
  const plain = chosen(transfer.files), found: NamedFile[] = [];
  if (entries.length === 0) return plain;
  for (const entry of entries) await find(entry, "", found);
  return found;
}

export function chosen(files: FileList): NamedFile[] {
  return [...files].map((file) => ({ name: file.name, file }));
}

/** Opens a model. \returns its name and the module's answer. */
export async function openFiles(client: Client, files: NamedFile[]): Promise<{ name: string; opened: Answer }> {
  const model = files.reduce((best, one) => (rank(one) < rank(best) ? one : best)), { name } = model;
  if (files.length === 1) return { name, opened: await client.ask({ ask: "open", name }, await model.file.arrayBuffer()) };
  for (const [i, one] of files.entries()) await client.ask({ ask: "file", name: one.name, first: i === 0 }, await one.file.arrayBuffer());
  return { name, opened: await client.ask({ ask: "open", name }) };
}
