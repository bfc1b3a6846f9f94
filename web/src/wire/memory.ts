// SPDX-License-Identifier: Apache-2.0
// The page's memory in the browser. If the browser forbids it, nothing is stored.

function read(storage: () => Storage, key: string): string {
  try {
    return storage().getItem(key) ?? "";
  } catch {
    return "";
  }
}

/// @returns whether it is kept: private windows and full disks keep nothing, and the page works without
function write(storage: () => Storage, key: string, value: string): boolean {
  try {
    storage().setItem(key, value);
  } catch {
    return false;
  }
  return read(storage, key) === value;
}

/// Until the tab is closed: a reload is the same page.
export const session = {
  get: (key: string) => read(() => sessionStorage, key),
  set: (key: string, value: string) => write(() => sessionStorage, key, value),
};

/// For this browser: theme, type size, name.
export const lasting = {
  get: (key: string) => read(() => localStorage, key),
  set: (key: string, value: string) => write(() => localStorage, key, value),
};
