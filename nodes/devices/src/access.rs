//! What keeps a user from a device, and what to do about it.

use rustix::fs::Access;
use std::os::unix::fs::MetadataExt as _;
use std::path::Path;

/// What the system says of a device and of this user.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Facts {
    /// The group that owns it.
    pub group: String,
    /// That group may read and write it.
    pub group_may: bool,
    /// The user is entered as a member of that group.
    pub is_member: bool,
}

/// What to do when the system refuses.
pub fn advice(facts: &Facts) -> String {
    let Facts { group, group_may, is_member } = facts;
    match (group_may, is_member) {
        (false, _) => {
            "not even its group may use it: a udev rule with MODE=\"0660\" and GROUP=\"plugdev\" would help".to_owned()
        }
        (true, true) => {
            format!("the user is in group {group} since the last login began: log out and in again")
        }
        (true, false) => {
            format!("it belongs to group {group}: `sudo usermod -aG {group} $USER`, then log out and in again")
        }
    }
}

/// What to do before this program may read and write a device; none when it may.
pub fn missing(device: &Path) -> Option<String> {
    if rustix::fs::access(device, Access::READ_OK | Access::WRITE_OK).is_ok() {
        return None;
    }
    let metadata = std::fs::metadata(device).ok()?;
    let groups = std::fs::read_to_string("/etc/group").unwrap_or_default();
    let users = std::fs::read_to_string("/etc/passwd").unwrap_or_default();
    let me = std::fs::metadata("/proc/self").map(|own| own.uid()).unwrap_or_default();
    let user = by_number(&users, me).map(|(name, _)| name);
    let (group, members) = by_number(&groups, metadata.gid()).unwrap_or(("unknown", ""));
    Some(advice(&Facts {
        group: group.to_owned(),
        group_may: metadata.mode() & 0o060 == 0o060,
        is_member: user.is_some_and(|user| members.split(',').any(|member| member == user)),
    }))
}

/// Name and last field of the line with this number in the third field: `name:x:number:…:last`.
fn by_number(table: &str, number: u32) -> Option<(&str, &str)> {
    table.lines().find_map(|line| {
        let fields: Vec<&str> = line.split(':').collect();
        (fields.get(2)?.parse() == Ok(number)).then_some((*fields.first()?, *fields.last()?))
    })
}
