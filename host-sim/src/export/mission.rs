//! Ways as MAVLink missions, in the two formats of ground stations: `.plan` of
//! QGroundControl and the plain `.waypoints` of Mission Planner.
//!
//! A mission takes off at the first place and goes from turn to turn. Where that leads back to
//! the first place it lands there; else it ends hovering, as nobody knows where a landing is
//! safe.

use std::io::{self, Write};
use std::str::FromStr;

use serde_json::{Value, json};

use super::Way;

/// Equatorial radius of the Earth in metres (WGS 84).
const EARTH: f64 = 6_378_137.0;

/// Commands of MAVLink: fly to, land, take off.
const WAYPOINT: u16 = 16;
const LAND: u16 = 21;
const TAKEOFF: u16 = 22;

/// The frame of MAVLink whose altitudes count from home.
const RELATIVE: u8 = 3;

/// Where the origin of a scene's file lies on the Earth: x leads east, y north, z up.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Home {
    /// Degrees north, -85 to 85.
    pub latitude: f64,
    /// Degrees east, -180 to 180.
    pub longitude: f64,
}

impl FromStr for Home {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let numbers = text.split_once(',');
        let numbers = numbers.and_then(|(north, east)| {
            let (latitude, longitude) = (north.parse().ok()?, east.parse().ok()?);
            let is_on_map =
                (-85.0..=85.0).contains(&latitude) && (-180.0..=180.0).contains(&longitude);
            is_on_map.then_some(Self {
                latitude,
                longitude,
            })
        });
        numbers.ok_or_else(|| {
            "expected LATITUDE,LONGITUDE in degrees, -85 to 85 and -180 to 180".into()
        })
    }
}

impl Home {
    /// Latitude and longitude of a point in metres: good to a centimetre within a
    /// kilometre.
    fn degrees(self, [east, north, _]: [f64; 3]) -> (f64, f64) {
        let degrees = |metres: f64, radius: f64| (metres / radius).to_degrees();
        let radius = EARTH * libm::cos(self.latitude.to_radians());
        (
            self.latitude + degrees(north, EARTH),
            self.longitude + degrees(east, radius),
        )
    }
}

/// The mission of one robot as QGroundControl's `.plan`; `speed` in metres a second.
pub fn plan(way: &Way, home: Home, speed: f64) -> Value {
    let items = commands(way).map(|(number, command, point)| {
        let (latitude, longitude) = home.degrees(point);
        json!({
            "type": "SimpleItem",
            "autoContinue": true,
            "command": command,
            "doJumpId": number + 1,
            "frame": RELATIVE,
            "params": [0, acceptance(command, way), 0, null, latitude, longitude, point[2]],
        })
    });
    json!({
        "fileType": "Plan",
        "groundStation": "QGroundControl",
        "version": 1,
        "geoFence": { "circles": [], "polygons": [], "version": 2 },
        "rallyPoints": { "points": [], "version": 2 },
        "mission": {
            "version": 2,
            "firmwareType": 0,
            "vehicleType": 2,
            "globalPlanAltitudeMode": 1,
            "cruiseSpeed": speed,
            "hoverSpeed": speed,
            "plannedHomePosition": [home.latitude, home.longitude, 0],
            "items": items.collect::<Vec<_>>(),
        },
    })
}

/// Writes the mission of one robot as a `.waypoints` file.
///
/// # Errors
/// Those of `to`.
pub fn waypoints(way: &Way, home: Home, mut to: impl Write) -> io::Result<()> {
    writeln!(to, "QGC WPL 110")?;
    let mut line = |number: usize, frame: u8, command: u16, (north, east): (f64, f64), up: f64| {
        let current = u8::from(number == 0);
        let near = match number {
            0 => 0.0,
            _ => acceptance(command, way),
        };
        writeln!(
            to,
            "{number}\t{current}\t{frame}\t{command}\t0\t{near}\t0\t0\t{north:.8}\t{east:.8}\t{up:.3}\t1"
        )
    };
    // Item 0 is home.
    line(0, 0, WAYPOINT, (home.latitude, home.longitude), 0.0)?;
    commands(way).try_for_each(|(number, command, point)| {
        line(number + 1, RELATIVE, command, home.degrees(point), point[2])
    })
}

/// How near to a turn the vehicle has to come, in metres: half a cell. With 0 autopilots take
/// metres of their own, more than rooms have.
fn acceptance(command: u16, way: &Way) -> f64 {
    match command {
        WAYPOINT => way.cell / 2.0,
        _ => 0.0,
    }
}

/// Number, command and place of each item.
fn commands(way: &Way) -> impl Iterator<Item = (usize, u16, [f64; 3])> {
    let flown = way.places.iter().enumerate().map(|(number, &place)| {
        let command = if number == 0 { TAKEOFF } else { WAYPOINT };
        (command, place)
    });
    let landing = way.landing().map(|place| (LAND, place));
    let items = flown.chain(landing).enumerate();
    items.map(|(number, (command, place))| (number, command, place))
}

#[cfg(test)]
mod tests {
    use super::*;

    const HOME: Home = Home {
        latitude: 60.0,
        longitude: -1.0,
    };

    /// A degree is 111,319.49 m, and half of that along the parallel of 60° north.
    #[test]
    fn metres_are_degrees() {
        let degree = EARTH.to_radians();
        let (north, east) = HOME.degrees([degree / 2.0, degree / 4.0, 9.0]);
        assert!(
            (north - 60.25).abs() < 1e-9 && east.abs() < 1e-9,
            "{north} {east}"
        );
    }

    #[test]
    fn missions_take_off_and_fly_to_every_turn() {
        let mut way = Way {
            places: vec![[0.0, 0.0, 1.5], [1.0, 0.0, 1.5]],
            ground: 0.5,
            is_ground_known: true,
            cell: 0.5,
        };
        let mut file = Vec::new();
        waypoints(&way, HOME, &mut file).unwrap();
        assert_eq!(
            String::from_utf8(file).unwrap(),
            "QGC WPL 110\n\
             0\t1\t0\t16\t0\t0\t0\t0\t60.00000000\t-1.00000000\t0.000\t1\n\
             1\t0\t3\t22\t0\t0\t0\t0\t60.00000000\t-1.00000000\t1.500\t1\n\
             2\t0\t3\t16\t0\t0.25\t0\t0\t60.00000000\t-0.99998203\t1.500\t1\n"
        );
        let plan = plan(&way, HOME, 2.0);
        let items = plan["mission"]["items"].as_array().unwrap();
        assert_eq!(
            (&items[0]["command"], &items[1]["command"]),
            (&json!(22), &json!(16))
        );
        assert_eq!(items[1]["params"][6], 1.5);
        assert_eq!(plan["mission"]["hoverSpeed"], 2.0);
        assert_eq!(items.len(), 2);
        // Back home it lands.
        way.places.push(way.places[0]);
        let mut file = Vec::new();
        waypoints(&way, HOME, &mut file).unwrap();
        let text = String::from_utf8(file).unwrap();
        assert_eq!(
            text.lines().last(),
            Some("4\t0\t3\t21\t0\t0\t0\t0\t60.00000000\t-1.00000000\t0.500\t1")
        );
    }

    #[test]
    fn a_home_is_two_numbers_of_degrees() {
        assert_eq!("60,-1".parse(), Ok(HOME));
        for wrong in ["", "60", "60,-1,3", "91,0", "0,181", "nan,0"] {
            assert!(wrong.parse::<Home>().is_err(), "{wrong}");
        }
    }
}
