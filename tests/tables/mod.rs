//! Tables as files: every format both ways, files of other programs, what is refused.

mod damage;
mod digits;
mod factored;
mod foreign;
mod grid;
mod independent;
mod refused;
mod round_trip;
mod scene;
mod sets;

use sets::{
    Dice, ENDINGS, FT_LBF, bits, bogie_grid, bytes, data, folder, girderway, random_factored,
    random_set, table, told,
};
