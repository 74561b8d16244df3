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
    Some(advice(&facts([metadata.mode(), metadata.gid()], me, &users, &groups)))
}

/// What is known of a device with this mode and group, and of the user with this number, by the tables of users and groups
/// (`/etc/passwd`, `/etc/group`). A user is a member of the groups that list it, and of its own.
pub fn facts([mode, group]: [u32; 2], user: u32, users: &str, groups: &str) -> Facts {
    let own = by_number(users, user);
    let listed = by_number(groups, group);
    let members = listed.as_ref().and_then(|fields| fields.get(3)).copied().unwrap_or_default();
    let is_own = own.as_ref().is_some_and(|fields| fields.get(3).is_some_and(|own| own.parse() == Ok(group)));
    let is_listed = own.as_ref().is_some_and(|fields| members.split(',').any(|member| member == fields[0]));
    Facts {
        group: listed.map_or("unknown", |fields| fields[0]).to_owned(),
        group_may: mode & 0o060 == 0o060,
        is_member: is_own || is_listed,
    }
}

/// The fields of the line with this number in the third: `name:x:number:…`.
fn by_number(table: &str, number: u32) -> Option<Vec<&str>> {
    let mut lines = table.lines().map(|line| line.split(':').collect::<Vec<_>>());
    lines.find(|fields| fields.get(2).is_some_and(|field| field.parse() == Ok(number)))
}
