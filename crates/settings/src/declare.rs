/// Declares a struct of settings.
///
/// Each setting is `name: type = default, "unit", rule;` under its documentation, which is its meaning everywhere. The
/// rules are the functions of [`rule`](crate::rule). A setting that may be left out has the type `Option` and the
/// default `None`, and `example value` after its rule. After the struct may come:
///
/// - `sections { name: Type; }`: other structs of settings, the tables of the file;
/// - `order { a > b; }`: which of two settings is the larger one, by `>`, `>=`, `<` or `<=`; the first of the two is named
///   where they are not so, lists are compared number by number;
/// - `require { a: "words" => |s| condition; }`: any other condition; the words follow 'it must be', and `a` is the setting
///   that is named.
///
/// `require` may name settings of sections, as in `paper.shell_outer`. Its fields are as visible as the struct, which implements
/// [`Default`], [`Settings`](crate::Settings), `Serialize` and `Deserialize`.
///
/// The struct is `#[non_exhaustive]`, so that settings can be added. Other crates change its defaults:
/// `Config::default().with(|c| c.method = method)`.
#[macro_export]
macro_rules! settings {
    (
        $(#[doc = $about:literal])+
        $vis:vis struct $name:ident {
            $(
                $(#[doc = $doc:literal])+
                $field:ident : $type:ty = $default:expr, $unit:literal, $rule:expr $(, example $example:expr)? ;
            )*
        }
        $(sections {
            $(
                $(#[doc = $section_doc:literal])+
                $section:ident : $section_type:ty ;
            )+
        })?
        $(order {
            $(
                $larger:ident $operator:tt $smaller:ident ;
            )+
        })?
        $(require {
            $(
                $held:ident $(. $held_part:ident)* : $words:literal => $condition:expr ;
            )+
        })?
    ) => {
        $(#[doc = $about])+
        #[derive(
            Clone,
            Debug,
            PartialEq,
            $crate::serde::Serialize,
            $crate::serde::Deserialize,
        )]
        #[serde(crate = "pomona_settings::serde", default, deny_unknown_fields)]
        #[non_exhaustive]
        $vis struct $name {
            $(
                $(#[doc = $doc])+
                #[doc = ""]
                #[doc = concat!(
                    "Unit: ", $unit, ". Default: `", stringify!($default), "`. Rule: `", stringify!($rule), "`."
                )]
                $vis $field: $type,
            )*
            $($(
                $(#[doc = $section_doc])+
                $vis $section: $section_type,
            )+)?
        }

        impl Default for $name {
            fn default() -> Self {
                Self {
                    $($field: $default,)*
                    $($($section: Default::default(),)+)?
                }
            }
        }

        impl $name {
            /// These settings after a change.
            #[must_use]
            pub fn with(mut self, change: impl FnOnce(&mut Self)) -> Self {
                change(&mut self);
                self
            }

            /// Checks every setting.
            ///
            /// # Errors
            ///
            /// [`ConfigError::Value`](pomona_settings::ConfigError::Value) for the first one that breaks a rule.
            pub fn validate(&self) -> Result<(), $crate::ConfigError> {
                $crate::Settings::check(self, "")
            }
        }

        impl $crate::Settings for $name {
            fn describe(prefix: &str, description: &mut $crate::Description) {
                #[allow(unused_imports, reason = "a struct of sections alone has no rules")]
                use $crate::rule::*;
                #[allow(unused_variables, reason = "nor defaults")]
                let defaults = Self::default();
                $(
                    let setting = $crate::Setting::new(
                        $crate::check::path(prefix, stringify!($field)),
                        &defaults.$field,
                        &[$($doc),+],
                        $unit,
                        $rule,
                    );
                    $(
                        let example: $type = Some($example);
                        let setting = setting.with_example(&example);
                    )?
                    description.settings.push(setting);
                )*
                $($(
                    let path = $crate::check::path(prefix, stringify!($section));
                    description.add_section(path.clone(), &[$($section_doc),+]);
                    <$section_type as $crate::Settings>::describe(&path, description);
                )+)?
                $($(
                    description.relate(
                        &$crate::check::path(prefix, stringify!($larger)),
                        format!(
                            "{} {}",
                            $crate::check::operator_words(stringify!($operator)),
                            $crate::check::path(prefix, stringify!($smaller)),
                        ),
                    );
                )+)?
                $($(
                    let held = concat!(stringify!($held) $(, ".", stringify!($held_part))*);
                    description.relate(&$crate::check::path(prefix, held), $words.to_owned());
                )+)?
            }

            fn check(&self, prefix: &str) -> Result<(), $crate::ConfigError> {
                #[allow(unused_imports, reason = "a struct of sections alone has no rules")]
                use $crate::rule::*;
                $(
                    $crate::check::rule(prefix, stringify!($field), &self.$field, $rule)?;
                )*
                $($(
                    let path = $crate::check::path(prefix, stringify!($section));
                    $crate::Settings::check(&self.$section, &path)?;
                )+)?
                $($(
                    $crate::check::order(
                        prefix,
                        (stringify!($larger), &self.$larger),
                        (stringify!($operator), |a, b| a $operator b),
                        (stringify!($smaller), &self.$smaller),
                    )?;
                )+)?
                $($(
                    let condition: fn(&Self) -> bool = $condition;
                    let held = concat!(stringify!($held) $(, ".", stringify!($held_part))*);
                    let value = &self.$held $(.$held_part)*;
                    $crate::check::require(condition(self), prefix, held, value, || $words.to_owned())?;
                )+)?
                Ok(())
            }
        }
    };
}
