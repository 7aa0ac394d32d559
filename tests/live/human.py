"""A scripted person with a game controller, who plays through the page's own input."""

GAMEPAD = """
const buttons = [...Array(17)].map(() => ({ pressed: false, value: 0 }));
window.pad = { connected: true, axes: [0, 0, 0, 0], buttons };
navigator.getGamepads = () => [window.pad];
"""

PLAYER = """
/* Behind the ball on the line to the goal, through it, and kick: by sticks and trigger alone. */
clearInterval(window.person);
window.person = setInterval(() => {
  const { match } = window.robobt, frame = match.frames - 1;
  if (frame < 0) return;
  const at = 4 * frame, robot = match.robots[0];
  const [x, y, heading] = [0, 1, 2].map(i => robot.rows[at + i] / 1000);
  const [bx, by] = [0, 1].map(i => match.ball[at + i] / 1000);
  const turned = angle => Math.atan2(Math.sin(angle), Math.cos(angle));
  /* A stick in its middle tells nothing. */
  const stick = value => Math.sign(value) * Math.min(1, .12 + .88 * Math.abs(value));
  const aim = Math.atan2(-by, match.field.length / 2 - bx);
  const off = Math.abs(turned(Math.atan2(by - y, bx - x) - aim));
  const near = Math.hypot(bx - x, by - y) < .4 && off < .2, turn = turned(aim - heading);
  const [tx, ty] = near ? [bx, by] : [bx - .3 * Math.cos(aim), by - .3 * Math.sin(aim)];
  const held = robot.flags.values.length && robot.flags.values[robot.flags.values.length - 1] & 1;
  window.pad.axes[0] = stick(tx - x);
  window.pad.axes[1] = -stick(ty - y);
  window.pad.axes[2] = -stick(.25 * turn);
  /* The trigger is held on the way and let go when the ball lies in front and the goal ahead. */
  window.pad.buttons[7].pressed = near && !(held && Math.abs(turn) < .08);
}, 15);
"""
