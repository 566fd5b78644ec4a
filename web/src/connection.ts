// The stream of messages, opened again whenever it ends.

import { Command, decode, type Message } from './protocol';

const FIRST_PAUSE_MS = 400;
const LONGEST_PAUSE_MS = 4000;

export interface ConnectionListener {
  onMessages(messages: Message[]): void;
  onStateChange(isOpen: boolean, problem: string): void;
}

export class Connection {
  private socket: WebSocket | null = null;
  private pause = FIRST_PAUSE_MS;
  bytes = 0; // received

  constructor(private readonly listener: ConnectionListener) {
    this.open();
  }

  send(command: Command): void {
    if (this.socket?.readyState === WebSocket.OPEN) this.socket.send(new Uint8Array([command]));
  }

  private open(): void {
    const address = new URL('stream' + location.search, location.href);
    address.protocol = location.protocol === 'https:' ? 'wss:' : 'ws:';
    const socket = new WebSocket(address);
    this.socket = socket;
    socket.binaryType = 'arraybuffer';
    let problem = '';
    socket.onopen = () => {
      this.pause = FIRST_PAUSE_MS;
      this.listener.onStateChange(true, '');
    };
    socket.onmessage = (event: MessageEvent<ArrayBuffer>) => {
      this.bytes += event.data.byteLength;
      try {
        this.listener.onMessages(decode(event.data));
      } catch (error) {
        problem = error instanceof Error ? error.message : String(error);
        socket.close();
      }
    };
    socket.onclose = () => {
      this.listener.onStateChange(false, problem);
      setTimeout(() => this.open(), this.pause);
      this.pause = Math.min(2 * this.pause, LONGEST_PAUSE_MS);
    };
  }
}
