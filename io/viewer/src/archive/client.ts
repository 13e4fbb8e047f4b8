// The page's side of the worker: a call per verb. A worker that broke is replaced, and the archive opened again in the
// new one before anything else is asked of it.
import type {} from "./start";
import type { FromWorker, Opened, Requests, Verb } from "./protocol";

interface Waiting {
  done(answer: unknown): void;
  failed(error: Error): void;
  part?(part: unknown): void;
}

export class Client {
  private worker = this.start();
  private readonly waiting = new Map<number, Waiting>();
  private next = 0;
  private opened: Opened | null = null;
  private opening = -1; // number of the call that opens it

  /** Told how many bytes were fetched since the page opened, and whether the worker is at work. */
  onProgress: (bytes: number, busy: boolean) => void = () => {};
  private bytes = 0;

  open(opened: Opened): Promise<Requests["open"]["answer"]> {
    this.opened = opened;
    this.opening = this.next;
    return this.call("open", opened);
  }

  call<V extends Verb>(verb: V, ask: Requests[V]["ask"]): Promise<Requests[V]["answer"]> {
    return this.send(verb, ask).answer;
  }

  /** A call whose answer comes in parts; the function returned stops it. */
  stream<V extends Verb>(verb: V, ask: Requests[V]["ask"], part: (part: unknown) => void) {
    return this.send(verb, ask, part);
  }

  private send<V extends Verb>(verb: V, ask: Requests[V]["ask"], part?: (part: unknown) => void) {
    const number = this.next++;
    const answer = new Promise<Requests[V]["answer"]>((done, failed) => {
      this.waiting.set(number, { done: done as (answer: unknown) => void, failed, part });
    });
    this.worker.postMessage({ number, verb, ask });
    this.onProgress(this.bytes, true);
    return { answer, cancel: () => this.worker.postMessage({ cancel: number }) };
  }

  private start(): Worker {
    const worker = newReader();
    worker.onmessage = ({ data }: MessageEvent<FromWorker>) => this.receive(data);
    worker.onerror = () => this.replace("the reader of the archive stopped");
    return worker;
  }

  private receive(message: FromWorker): void {
    if ("fetched" in message) {
      this.bytes = message.fetched;
      this.onProgress(this.bytes, this.waiting.size > 0);
      return;
    }
    const waiting = this.waiting.get(message.number);
    if (!waiting) return;
    if ("part" in message) {
      waiting.part?.(message.part);
      return;
    }
    this.waiting.delete(message.number);
    if ("answer" in message) waiting.done(message.answer);
    else {
      waiting.failed(new Error(message.sentence));
      if (message.fatal && message.number === this.opening) this.opened = null; // it would break the next one too
      if (message.fatal) this.replace(message.sentence);
    }
    this.onProgress(this.bytes, this.waiting.size > 0);
  }

  private replace(sentence: string): void {
    this.worker.terminate();
    for (const waiting of this.waiting.values()) waiting.failed(new Error(sentence));
    this.waiting.clear();
    this.worker = this.start();
    if (this.opened) void this.open(this.opened).catch(() => {});
  }
}
