// SPDX-License-Identifier: Apache-2.0
/** Values that views watch, in a few owners. Setting values calls the watchers of what changed once, in the same turn. A store of
 * many owners is also one of some of them. */

/** An owner, or one of its values as `owner.value`. */
export type Path<T> = {
  [O in keyof T & string]: O | `${O}.${keyof T[O] & string}`;
}[keyof T & string];

/** Values of any owners. */
type Change<T> = { [O in keyof T]?: Partial<T[O]> };

export class Store<T extends { [O in keyof T]: object }> {
  private readonly listeners: { paths: readonly string[]; call(value: T): void }[] = [];
  private changed = new Set<string>();
  private notifying = false;

  constructor(private value: T) {}

  get(): Readonly<T> {
    return this.value;
  }

  set(change: Change<T>): void {
    for (const owner of Object.keys(change) as (keyof T & string)[]) {
      const before = this.value[owner],
        after = { ...before, ...change[owner] };
      for (const name of Object.keys(after) as (keyof T[typeof owner] & string)[])
        if (!Object.is(before[name], after[name])) this.changed.add(owner).add(`${owner}.${name}`);
      this.value = { ...this.value, [owner]: after };
    }
    if (!this.notifying) this.notify();
  }

  /** Calls at once, and then whenever one of the values has changed. Gives what ends it. */
  watch(paths: readonly Path<T>[], call: (value: T) => void): () => void {
    const listener = { paths, call };
    this.listeners.push(listener);
    call(this.value);
    return () => {
      const at = this.listeners.indexOf(listener);
      if (at >= 0) this.listeners.splice(at, 1);
    };
  }

  private notify(): void {
    this.notifying = true;
    const kMostRounds = 50; // watchers may set values; more rounds than this are a loop
    try {
      for (let round = 0; this.changed.size > 0; ++round) {
        if (round === kMostRounds) throw new Error("Watchers of the store set each other off without end.");
        const changed = this.changed;
        this.changed = new Set();
        for (const listener of [...this.listeners])
          if (listener.paths.some(path => changed.has(path))) listener.call(this.value);
      }
    } finally {
      this.notifying = false;
    }
  }
}
