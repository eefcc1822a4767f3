// SPDX-License-Identifier: Apache-2.0
// Files that are dropped or chosen: a model, and the files that it names beside it or in folders below.
import type { Answer } from "./answer.ts";
import type { Client } from "./client.ts";

export interface NamedFile { name: string; file: File }

/** Suffixes of models, and of what they name. What comes first is the model where there are several. */
const models = [".glb", ".gltf", ".obj", ".stl", ".ply", ".off"];
export const accepted = [...models, ".mtl", ".bin", ".png", ".jpg", ".jpeg"].join(",");
const rank = ({ name }: NamedFile) => {
  const of = models.findIndex((suffix) => name.toLowerCase().endsWith(suffix));
  return (of < 0 ? models.length : of) + 100 * name.split("/").length;
};

async function below(entry: FileSystemEntry, path: string): Promise<NamedFile[]> {
  if (entry.isFile) {
    const file = await new Promise<File>((found, fail) => (entry as FileSystemFileEntry).file(found, fail));
    return [{ name: path + entry.name, file }];
  }
  const reader = (entry as FileSystemDirectoryEntry).createReader(), found: NamedFile[] = [];
  for (;;) {
    const some = await new Promise<FileSystemEntry[]>((take, fail) => reader.readEntries(take, fail));
    if (some.length === 0) return found;
    for (const one of some) found.push(...(await below(one, `${path}${entry.name}/`)));
  }
}

/** All that was dropped, folders with what is in them. To be called before anything is waited for. */
export async function dropped(transfer: DataTransfer): Promise<NamedFile[]> {
  const entries = [...transfer.items].map((item) => item.webkitGetAsEntry?.()).filter((entry) => entry !== null && entry !== undefined);
  const plain = chosen(transfer.files);
  if (entries.length === 0) return plain;
  return (await Promise.all(entries.map((entry) => below(entry, "")))).flat();
}

export function chosen(files: FileList): NamedFile[] {
  return [...files].map((file) => ({ name: file.name, file }));
}

/** \returns what the module tells of the model, and its name. */
export async function openFiles(client: Client, files: NamedFile[]): Promise<{ name: string; opened: Answer }> {
  const [model, ...others] = [...files].sort((a, b) => rank(a) - rank(b));
  const { name } = model;
  if (others.length === 0) return { name, opened: await client.ask({ ask: "open", name }, await model.file.arrayBuffer()) };
  for (const one of files) await client.ask({ ask: "file", name: one.name }, await one.file.arrayBuffer());
  return { name, opened: await client.ask({ ask: "open", name }) };
}
