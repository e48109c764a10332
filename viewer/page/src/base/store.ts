// SPDX-License-Identifier: Apache-2.0
/** One object of values that views watch. Setting a value calls the watchers of changed keys once, in the same turn. */

export class Store<T extends object> {
  private readonly listeners: { keys: Set<keyof T>; call: (value: T) => void }[] = [];
  private changed = new Set<keyof T>();
  private notifying = false;

  constructor(private value: T) {}

  get(): Readonly<T> {
    return this.value;
  }

  set(patch: Partial<T>): void {
    for (const key of Object.keys(patch) as (keyof T)[])
      if (!Object.is(this.value[key], patch[key])) this.changed.add(key);
    this.value = { ...this.value, ...patch };
    if (!this.notifying) this.notify();
  }

  /** Calls at once, and then whenever one of the keys has changed. Gives what ends it. */
  watch(keys: (keyof T)[], call: (value: T) => void): () => void {
    const listener = { keys: new Set(keys), call };
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
          if ([...listener.keys].some(key => changed.has(key))) listener.call(this.value);
      }
    } finally {
      this.notifying = false;
    }
  }
}
