/* The connection to the match: messages come and go as long as the page is there. */
export const VERSION = 1;
const handlers = {};
let socket = null;

/* Call what is given with each message of a kind; "lost" and "found" tell of the connection. */
export const on = (kind, handler) => { handlers[kind] = handler; };
const tell = (kind, message) => { if (handlers[kind]) handlers[kind](message); };
export const connected = () => Boolean(socket) && socket.readyState === WebSocket.OPEN;
/* Whether it was sent; what cannot be sent now is not sent later, for then it would be wrong. */
export const send = message => {
  if (!connected()) return false;
  socket.send(JSON.stringify(message));
  return true;
};
export const connect = () => {
  socket = new WebSocket(new URL("socket", location.href).href.replace(/^http/, "ws"));
  socket.addEventListener("open", () => tell("found"));
  socket.addEventListener("message", event => { const message = JSON.parse(event.data); tell(message.kind, message); });
  socket.addEventListener("close", () => { tell("lost"); setTimeout(connect, 1000); });
};
