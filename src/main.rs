//! `post`: turns a cutter-location file into the NC program of one machine.

fn main() {
    post_command::run()
}
