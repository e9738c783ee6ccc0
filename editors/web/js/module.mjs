// `post.wasm`, and the requests that it takes: a line of JSON each with bytes behind it, and an answer of the same form.

/** Bytes of a file in one request. */
const PIECE = 1 << 20;

/** The module has died of a fault of `post`; it takes no more requests. */
export class PostFault extends Error {
  name = "PostFault";
}

/** `post` with a disk of its own in memory. */
export class Post {
  #exports;
  #died = null;
  /** Is told how many bytes are read, and of how many (below zero: nobody knows). */
  progress = () => {};

  /** Of a compiled WebAssembly.Module. */
  static async of(module) {
    const post = new Post();
    const lent = {
      progress: (done, of) => post.progress(done, of),
      died: (at, length) => {
        post.#died = new TextDecoder().decode(post.#bytes(at, length));
      },
    };
    const instance = await WebAssembly.instantiate(module, { post: lent });
    post.#exports = instance.exports;
    return post;
  }

  #bytes(at, length) {
    return new Uint8Array(this.#exports.memory.buffer, at >>> 0, length >>> 0);
  }

  /** Asks for something: what is told, and the bytes behind it, which are good until the next request. */
  ask(what, bytes = new Uint8Array()) {
    if (this.#died !== null) {
      throw new PostFault(this.#died);
    }
    const head = new TextEncoder().encode(`${JSON.stringify(what)}\n`);
    const length = head.length + bytes.length;
    try {
      const at = this.#exports.request(length);
      const request = this.#bytes(at, length);
      request.set(head);
      request.set(bytes, head.length);
      // The answer may have moved the memory.
      const count = this.#exports.answer();
      return this.#split(this.#bytes(this.#exports.answer_at(), count));
    } catch (error) {
      if (!(error instanceof WebAssembly.RuntimeError)) {
        throw error;
      }
      this.#died ??= error.message;
      throw new PostFault(`a fault of post: ${this.#died}`, { cause: error });
    }
  }

  #split(answer) {
    const end = answer.indexOf(10);
    const told = JSON.parse(new TextDecoder().decode(answer.subarray(0, end)));
    if (told.fault !== undefined) {
      throw new Error(told.fault);
    }
    return { told, bytes: answer.subarray(end + 1) };
  }

  /** Puts a file on the disk, in the place of one of that name; `content` is text or bytes. */
  put(file, content) {
    this.remove(file);
    this.add(file, content);
  }

  /** Adds text or bytes at the end of a file, which is made if it is not there. */
  add(file, content) {
    const bytes = typeof content === "string" ? new TextEncoder().encode(content) : content;
    let at = 0;
    do {
      this.ask({ do: "add", file }, bytes.subarray(at, at + PIECE));
      at += PIECE;
    } while (at < bytes.length);
  }

  /** Takes a file off the disk. */
  remove(file) {
    this.ask({ do: "remove", file });
  }

  /** The bytes of a file, piece by piece; each piece is a copy. */
  *pieces(file) {
    for (let at = 0; ; ) {
      const { told, bytes } = this.ask({ do: "read", file, at });
      if (bytes.length > 0) {
        yield bytes.slice();
      }
      at += bytes.length;
      if (at >= told.length || bytes.length === 0) {
        return;
      }
    }
  }

  /** The bytes of a file. */
  read(file) {
    const pieces = [...this.pieces(file)];
    const whole = new Uint8Array(pieces.reduce((sum, piece) => sum + piece.length, 0));
    let at = 0;
    for (const piece of pieces) {
      whole.set(piece, at);
      at += piece.length;
    }
    return whole;
  }

  /** The text of a file. */
  text(file) {
    return new TextDecoder().decode(this.read(file));
  }

  /** Names and lengths of all files. */
  files() {
    return this.ask({ do: "files" }).told.files;
  }

  /** Runs a command line, `post` itself not among its words. */
  run(words) {
    return this.ask({ do: "run", words }).told;
  }

  /** Bytes of memory that it has. */
  get memory() {
    return this.#exports.memory.buffer.byteLength;
  }
}
