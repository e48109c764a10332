// SPDX-License-Identifier: Apache-2.0
/** The source of the page's data: the server, or the page itself. */
import type { Event, Operation, VesselAtClick, State } from "../base/types";

/** Called as bytes arrive: all received so far are in `bytes`, up to `received`. */
export type Received = (bytes: Uint8Array, received: number) => void;

export interface Answer {
  revision?: number;
}

/** The document has changed, or the request is wrong: the sentence is for people. */
export class Refused extends Error {
  constructor(
    readonly status: number,
    message: string,
  ) {
    super(message);
  }
}

/** The part that a file becomes, where its content leaves a choice. */
export type OpenAs = "auto" | "truth" | "second" | "labels";

export interface Source {
  /** False: what is embedded is all there is, and nothing can be edited. */
  readonly live: boolean;
  /** A sentence on where the data is, for the last line; empty where it goes without saying. */
  readonly where: string;
  /** Memory for a volume and all work on it; null: as the machine has it. */
  readonly mostBytes: number | null;
  state(): Promise<State>;
  /** The bytes of a pack or file; null if there is none. */
  bytes(
    name: string,
    query?: Record<string, string>,
    received?: Received,
    signal?: AbortSignal,
  ): Promise<Uint8Array | null>;
  listen(listener: (event: Event) => void): void;
  perform(operation: Operation, revision: number): Promise<Answer>;
  vesselAtClick(position: number[]): Promise<VesselAtClick>;
  open(name: string, as: OpenAs, file: globalThis.Blob): Promise<void>;
  /** Sends one file of a batch of DICOM. */
  sendSeriesFile(batch: number, file: File): Promise<void>;
  cancel(job: number): Promise<void>;
  /** Gives the user the document in that format as a file. */
  download(format: string, options?: Record<string, string>): Promise<void>;
}
