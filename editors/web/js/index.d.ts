/** A text that is given: alone, or with its name, by whose ending a CL file's kind is known. */
export type Text = string | Uint8Array | { name: string; content: string | Uint8Array };

/**
 * Options of the command, by the names of its flags: `toolLength` or `tool_length` is `--tool-length`. True is a flag
 * without a value, numbers of a list are joined by commas, other lists say the flag again and again.
 */
export interface Options {
  /** Is told how many bytes are read, and of how many (below zero: nobody knows). */
  progress?: (done: number, of: number) => void;
  /** Files that machine or CL file name: tools, solids, machines that are extended. */
  files?: Record<string, string | Uint8Array>;
  /** Length of every tool from the gauge point to the tip, mm. */
  toolLength?: number;
  /** Where the part origin sits, all axes at zero, machine frame, mm. */
  mount?: [number, number, number];
  /** Largest deviation of the tip, mm, over the machine file's. */
  tolerance?: number;
  /** Another dialect than the machine file names. */
  dialect?: string;
  /** Parameters (`Lm=312`) or any keys of the machine file. */
  set?: string[];
  [flag: string]: unknown;
}

export interface Finding {
  severity: "error" | "warning";
  /** Stable name, `over-travel`. */
  code: string;
  /** What, with the value and the limit. */
  message: string;
  /** What would help. */
  help: string | null;
  /** The file, as it was named. */
  file: string | null;
  /** Line of the file, counted from 1. */
  line: number | null;
  /** All of it as a terminal shows it. */
  shown: string;
}

export interface Result {
  /** The command would end with 0. */
  ok: boolean;
  /** 0 good, 1 refused, 2 the command line is wrong. */
  code: number;
  /** What the command prints to standard output. */
  printed: string;
  /** What it says to standard error, but for findings. */
  said: string;
  findings: Finding[];
}

export interface Told extends Result {
  /** The JSON that the command writes; none where it refuses. */
  summary: any;
}

export interface Posted extends Told {
  /** The bytes of the program; none where it is refused. */
  program: Uint8Array | null;
  /** The page of `--report`. */
  report: string | null;
}

export interface Verified extends Told {
  /** The page of `--report`. */
  report: string | null;
}

/** Posts a CL file on a machine: the name of one that is built in, or the text of a machine file. */
export function post(cl: Text, machine: Text, options?: Options & { report?: boolean }): Promise<Posted>;

/** Holds a program against the CL file that it was made from. */
export function verify(program: Text, cl: Text, machine: Text, options?: Options & { report?: boolean }): Promise<Verified>;

/** Looks a program over, without a CL file. */
export function lint(program: Text, machine: Text, options?: Options): Promise<Told>;

/** Reads a program: what it makes the machine do. */
export function read(program: Text, machine: Text, options?: Options): Promise<Told>;

/** What a machine file means, to be compared with the machine. */
export function check(machine: Text, options?: Options): Promise<Told>;

/** The JSON Schema of machine files. */
export function schema(): Promise<any>;

/** Runs any command line of `post`, itself not among the words, on these files. */
export function run(
  words: string[],
  files?: Record<string, string | Uint8Array>,
  options?: { progress?: (done: number, of: number) => void },
): Promise<Result & { files: Record<string, Uint8Array> }>;

/** Says where the module comes from, where it does not lie beside this file. */
export function load(source: BufferSource | WebAssembly.Module | Response | Promise<BufferSource | WebAssembly.Module | Response>): Promise<void>;

/** `post` with an empty disk in memory, for many runs on the same files. */
export function open(): Promise<Post>;

/** Options as words of the command line. */
export function words(options?: Record<string, unknown>): string[];

/** `post` with a disk of its own in memory. */
export class Post {
  static of(module: WebAssembly.Module): Promise<Post>;
  progress: (done: number, of: number) => void;
  /** Puts a file on the disk, in the place of one of that name. */
  put(file: string, content: string | Uint8Array): void;
  /** Adds at the end of a file. */
  add(file: string, content: string | Uint8Array): void;
  remove(file: string): void;
  read(file: string): Uint8Array;
  pieces(file: string): Generator<Uint8Array>;
  text(file: string): string;
  /** Names and lengths in bytes. */
  files(): [string, number][];
  run(words: string[]): Omit<Result, "ok">;
  /** Bytes of memory that it has. */
  readonly memory: number;
}

/** The module has died of a fault of `post`; it takes no more requests. */
export class PostFault extends Error {}
