// The orientation sensor of a phone or tablet, which turns the head about all three axes.

const rad = Math.PI / 180;

/** Returns the product of two quaternions (w, x, y, z): first `b`, then `a`. */
function product([aw, ax, ay, az], [bw, bx, by, bz]) {
  return [
    aw * bw - ax * bx - ay * by - az * bz,
    aw * bx + ax * bw + ay * bz - az * by,
    aw * by - ax * bz + ay * bw + az * bx,
    aw * bz + ax * by - ay * bx + az * bw,
  ];
}

const about = (axis, degrees) => [Math.cos((degrees * rad) / 2), ...[0, 1, 2].map((k) => (k === axis ? Math.sin((degrees * rad) / 2) : 0))];

/** Returns the orientation of a head that looks through a device: x to the right, y up, the view along -z. `alpha`, `beta` and `gamma` are
 *  the angles of the event `deviceorientation`, whose axes are east, north and up, and `screen` is the turn of the screen. All angles are
 *  in degrees. */
export function orientationOf({ alpha, beta, gamma }, screen) {
  const device = product(product(about(2, alpha), about(0, beta)), about(1, gamma));
  // The head's axes are those of the world turned by a quarter about east, and the screen can be turned within the device.
  return product(product(about(0, -90), device), about(2, -screen));
}

/** Returns the orientation that turns a head back to the heading ahead, for a head with the orientation `q`. The head stays level. */
function heading([w, x, y, z]) {
  const [right, ahead] = [-2 * (x * z + w * y), 1 - 2 * (x * x + y * y)];
  return about(1, Math.atan2(right, ahead) / rad);
}

export class Sensor {
  /** Calls `moved` with the orientation of the head (w, x, y, z) at each report of the sensor. A sensor in a holder is level; otherwise
   *  the first direction of the device is straight ahead. */
  constructor(moved, isLevel) {
    this.origin = null;
    this.reported = false;
    this.listen = (event) => {
      if (event.alpha === null) return;
      this.reported = true;
      const now = orientationOf(event, screen.orientation?.angle ?? 0);
      this.origin ??= isLevel ? heading(now) : [now[0], ...now.slice(1).map((part) => -part)];
      moved(product(this.origin, now));
    };
    addEventListener("deviceorientation", this.listen);
  }

  /** Makes the next direction of the device straight ahead. */
  centre() {
    this.origin = null;
  }

  stop() {
    removeEventListener("deviceorientation", this.listen);
  }
}

/** Asks for the permission to read the sensor. Returns an empty text, or the reason why the page cannot read the sensor. */
export async function sensorRefused() {
  if (!isSecureContext) return "A browser gives the orientation of a device only to pages that come over HTTPS. Serve this page over HTTPS.";
  if (!window.DeviceOrientationEvent) return "This browser has no orientation sensor.";
  const allowed = (await DeviceOrientationEvent.requestPermission?.().catch(() => "denied")) ?? "granted";
  return allowed === "granted" ? "" : "The device does not give its orientation to this page.";
}
