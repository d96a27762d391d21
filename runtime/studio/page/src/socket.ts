// A conversation with the program: JSON both ways, pictures to here.

export interface Seen { name: string; width: number; height: number; pixels: Uint8ClampedArray<ArrayBuffer> }
// eslint-disable-next-line @typescript-eslint/no-explicit-any
export type Message = Record<string, any>;

// Four bytes of length, JSON, then each camera's pixels.
export function readPicture(data: ArrayBuffer): { head: Message; cameras: Seen[] } {
  const length = new DataView(data).getUint32(0, true);
  const head = JSON.parse(new TextDecoder().decode(new Uint8Array(data, 4, length))) as Message;
  let at = 4 + length;
  const cameras = (head.cameras as { name: string; width: number; height: number }[]).map((camera) => {
    const size = camera.width * camera.height * 4;
    const pixels = new Uint8ClampedArray(data, at, size);
    at += size;
    return { ...camera, pixels };
  });
  return { head, cameras };
}

export interface Ears {
  text(message: Message): void;
  picture?(head: Message, cameras: Seen[]): void;
  closed(why: string): void;
}

export class Socket {
  private socket: WebSocket;
  constructor(path: string, ears: Ears, opened: () => void) {
    const address = new URL(path, location.href);
    address.protocol = "ws:";
    address.search = address.hash = "";
    this.socket = new WebSocket(address);
    this.socket.binaryType = "arraybuffer";
    this.socket.onopen = opened;
    this.socket.onmessage = (event) => {
      if (typeof event.data === "string") ears.text(JSON.parse(event.data));
      else {
        const { head, cameras } = readPicture(event.data);
        ears.picture?.(head, cameras);
      }
    };
    this.socket.onclose = (event) => ears.closed(event.reason);
  }
  say(message: Message): void {
    if (this.socket.readyState === WebSocket.OPEN) this.socket.send(JSON.stringify(message));
  }
}
